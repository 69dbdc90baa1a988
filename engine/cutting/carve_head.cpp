#include "engine/cutting/carve_head.h"

#include <algorithm>

namespace cavum {

bool carve_head(Octree& tooth, const DiamondPoint& point, Vec3 tip_mm, const Mat3& turned, std::vector<RemovedLeaf>& removed) noexcept {
  const double top = point.cutting_length_mm;
  // The head's box: the capsule around its axis, and the band of distances that changes around it.
  const double r = point.head_radius_mm + (k_distance_band_leaves + 1.0) * tooth.leaf_mm();
  const Vec3 end = tip_mm + turned * Vec3{0, 0, top};
  const Vec3 low{std::min(tip_mm.x, end.x) - r, std::min(tip_mm.y, end.y) - r, std::min(tip_mm.z, end.z) - r};
  const Vec3 high{std::max(tip_mm.x, end.x) + r, std::max(tip_mm.y, end.y) + r, std::max(tip_mm.z, end.z) + r};
  const auto head = [&](Vec3 mm) noexcept {
    return point.head_distance_mm(turned.transposed(mm - tip_mm));
  };
  // Trilinear interpolation of a hollow of radius R lies leaf²/(8R) a direction inside it, rounding of the codes adds 0.01 leaf.
  const double leaf = tooth.leaf_mm();
  const double clearance_mm = leaf * (0.01 + 0.25 * leaf / point.head_radius_mm);
  return tooth.carve(low, high, head, removed, clearance_mm);
}

}  // namespace cavum
