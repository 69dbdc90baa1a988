#include "grading/perforation/freed_sites.h"

#include <algorithm>
#include <cmath>

namespace cavum::grading {
namespace {

constexpr double k_edge_mm = 0.15;
constexpr int k_max_steps = 20;      // 3 mm in a hundredth of a second
constexpr double k_ahead_mm = 0.05;  // less than that is where the tip is already

}  // namespace

IVec3 FreedSites::cell(Vec3 p) {
  return {static_cast<int>(std::floor(p.x / k_edge_mm)),
          static_cast<int>(std::floor(p.y / k_edge_mm)),
          static_cast<int>(std::floor(p.z / k_edge_mm))};
}

void FreedSites::note(Vec3 from_mm, Vec3 to_mm, std::int64_t frame) {
  const int steps =
      std::clamp(static_cast<int>(length(to_mm - from_mm) / k_edge_mm), 1, k_max_steps);
  for (int k = 0; k <= steps; ++k)
    first_.emplace(cell(from_mm + (to_mm - from_mm) * (static_cast<double>(k) / steps)), frame);
}

bool FreedSites::ahead(Vec3 from, Vec3 to, double near_mm, std::int64_t frame) const {
  const Vec3 way = to - from;
  const double long_mm = length(way);
  const Vec3 along = long_mm > 1e-6 ? way / long_mm : Vec3{0, 0, -1};
  const Vec3 near{near_mm, near_mm, near_mm};
  const IVec3 a = cell(min(from, to) - near);
  const IVec3 b = cell(max(from, to) + near);
  for (int z = a.z; z <= b.z; ++z)
    for (int y = a.y; y <= b.y; ++y)
      for (int x = a.x; x <= b.x; ++x) {
        const auto found = first_.find({x, y, z});
        if (found == first_.end() || found->second >= frame) continue;
        const Vec3 at = Vec3{x + 0.5, y + 0.5, z + 0.5} * k_edge_mm - from;
        const double ahead_mm = dot(at, along);
        const Vec3 aside = at - along * ahead_mm;
        if (ahead_mm > k_ahead_mm && ahead_mm < long_mm + near_mm &&
            dot(aside, aside) < near_mm * near_mm)
          return true;
      }
  return false;
}

}  // namespace cavum::grading
