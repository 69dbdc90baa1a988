#include "scenarios/zones/zone_map.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"

namespace cavum::scenarios {
namespace {

constexpr double k_cos_45 = 0.70710678118654752440;

}  // namespace

const char* zone_name(Zone zone) noexcept {
  constexpr const char* k_names[k_zones] = {noop("outside"),         noop("target"),
                                            noop("leeway sides"),    noop("leeway bottom"),
                                            noop("container sides"), noop("container bottom"),
                                            noop("protected")};
  return k_names[static_cast<std::size_t>(zone)];
}

Wall wall_of(Vec3 d) noexcept {
  const double vertical = d.z, n = length(d);
  if (-vertical >= k_cos_45 * n) return Wall::floor;
  if (vertical >= k_cos_45 * n) return Wall::opening;
  if (std::fabs(d.x) >= std::fabs(d.y)) return d.x >= 0 ? Wall::mesial : Wall::distal;
  return d.y >= 0 ? Wall::buccal : Wall::lingual;
}

double ZoneMap::distance_mm(Vec3 p) const noexcept {
  const Vec3 q = (p - origin_mm_) / leaf_mm_ - Vec3{low_.x + 0.5, low_.y + 0.5, low_.z + 0.5};
  const Vec3 c{std::clamp(q.x, 0.0, size_.x - 1.0), std::clamp(q.y, 0.0, size_.y - 1.0),
               std::clamp(q.z, 0.0, size_.z - 1.0)};
  const IVec3 i{std::min(static_cast<int>(c.x), std::max(0, size_.x - 2)),
                std::min(static_cast<int>(c.y), std::max(0, size_.y - 2)),
                std::min(static_cast<int>(c.z), std::max(0, size_.z - 2))};
  const double fx = c.x - i.x, fy = c.y - i.y, fz = c.z - i.z;
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    const IVec3 leaf = low_ + IVec3{std::min(i.x + (k & 1), size_.x - 1),
                                    std::min(i.y + (k >> 1 & 1), size_.y - 1),
                                    std::min(i.z + (k >> 2), size_.z - 1)};
    sum += static_cast<double>(distance_mm_[index(leaf)]) * ((k & 1) != 0 ? fx : 1 - fx) *
           ((k >> 1 & 1) != 0 ? fy : 1 - fy) * ((k >> 2) != 0 ? fz : 1 - fz);
  }
  return sum + length(q - c) * leaf_mm_;
}

Wall ZoneMap::wall(IVec3 leaf) const noexcept {
  const IVec3 in{std::clamp(leaf.x, low_.x, low_.x + size_.x - 1),
                 std::clamp(leaf.y, low_.y, low_.y + size_.y - 1),
                 std::clamp(leaf.z, low_.z, low_.z + size_.z - 1)};
  return static_cast<Wall>(wall_[index(in)]);
}

}  // namespace cavum::scenarios
