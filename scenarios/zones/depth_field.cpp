#include "scenarios/zones/depth_field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/tooth/adjacent.h"
#include "engine/tooth/octree_edit.h"
#include "scenarios/zones/target_surface.h"

namespace cavum::scenarios {

DepthField::DepthField(const Tooth& tooth, IVec3 low, IVec3 high, ZoneWork& work)
    : leaf_mm_(tooth.octree.leaf_mm()) {
  constexpr double k_enclosed_leaves = 3;  // how far inside pulp counts: its own wall is no outside
  const Octree& tree = tooth.octree;
  const IVec3 n = tree.size();
  const auto held = [](int v, int most) { return std::clamp(v, 0, most); };
  low = {held(low.x, n.x - 1), held(low.y, n.y - 1), held(low.z, n.z - 1)};
  size_ = {std::max(1, held(high.x, n.x) - low.x), std::max(1, held(high.y, n.y) - low.y),
           std::max(1, held(high.z, n.z) - low.z)};
  first_mm_ = tree.centre_mm(low);
  const std::size_t cells = cells_of(size_);
  work.body_leaves(cells);
  const TissueSet enclosed = tissues_of(tooth, TissueKind::pulp);
  ShapeField outside{size_, std::vector<float>(cells), std::vector<std::uint8_t>(cells)};
  soft_.assign(cells, false);
  Octree::Cursor cursor;
  for_each_cell(size_, [&](std::size_t i, IVec3 cell) {
    const IVec3 leaf = low + cell;
    const std::uint8_t t = tree.tissue(leaf, cursor);
    outside.inside[i] = enclosed[t] || tree.is_solid(t) ? 1 : 0;
    soft_[i] = outside.inside[i] == 0 && t != k_air;
    outside.level_mm[i] = static_cast<float>(
        (enclosed[t] ? -k_enclosed_leaves : decode_distance(tree.distance_code(leaf, cursor))) *
        leaf_mm_);
  });
  const std::vector<NearestPoint> nearest = nearest_points(outside);
  depth_mm_.resize(cells);
  for_each_cell(size_, [&](std::size_t i, IVec3 cell) {
    const NearestPoint& near = nearest[i];
    const double away =
        near.found ? length(to_vec3(cell) - near.at()) : double(size_.x + size_.y + size_.z);
    depth_mm_[i] = static_cast<float>((outside.inside[i] != 0 ? away : -away) * leaf_mm_);
  });
}

bool DepthField::soft_outside(Vec3 p) const noexcept {
  const Vec3 q = (p - first_mm_) / leaf_mm_ + Vec3{0.5, 0.5, 0.5};
  if (!(q.x >= 0 && q.y >= 0 && q.z >= 0 && q.x < size_.x && q.y < size_.y && q.z < size_.z))
    return false;
  return soft_[index({static_cast<int>(q.x), static_cast<int>(q.y), static_cast<int>(q.z)})];
}

double DepthField::depth_mm(Vec3 p) const noexcept {
  const Vec3 q = (p - first_mm_) / leaf_mm_;
  const Vec3 c{std::clamp(q.x, 0.0, size_.x - 1.0), std::clamp(q.y, 0.0, size_.y - 1.0),
               std::clamp(q.z, 0.0, size_.z - 1.0)};
  const IVec3 i{static_cast<int>(c.x), static_cast<int>(c.y), static_cast<int>(c.z)};
  const double fx = c.x - i.x, fy = c.y - i.y, fz = c.z - i.z;
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    const double share = ((k & 1) != 0 ? fx : 1 - fx) * ((k >> 1 & 1) != 0 ? fy : 1 - fy) *
                         ((k >> 2) != 0 ? fz : 1 - fz);
    if (!(share > 0)) continue;
    sum += share * static_cast<double>(
                       depth_mm_[index({i.x + (k & 1), i.y + (k >> 1 & 1), i.z + (k >> 2)})]);
  }
  return sum - length(q - c) * leaf_mm_;
}

}  // namespace cavum::scenarios
