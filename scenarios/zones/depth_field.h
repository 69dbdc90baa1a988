// How deep a place lies below the outside of the tooth, square to the surface: what cavities that
// follow a surface are measured by.
#pragma once

#include <vector>

#include "engine/tooth/tooth.h"
#include "scenarios/zones/zone_work.h"

namespace cavum::scenarios {

class DepthField {
 public:
  /// Of the leaves from `low` up to `high` (without it), held within the tooth. Pulp is inside the
  /// tooth; periodontium and air are not. Counts its leaves in `work`. Distances are right to half
  /// a leaf where the nearest surface lies in that box.
  DepthField(const Tooth& tooth, IVec3 low, IVec3 high, ZoneWork& work);
  /// Below the surface, mm; negative outside. Between leaves interpolated; beyond the box it counts
  /// as further outside.
  [[nodiscard]] double depth_mm(Vec3 p) const noexcept;
  /// Soft tissue that lies around the tooth there (periodontium): none of any cavity. False beyond
  /// the box.
  [[nodiscard]] bool soft_outside(Vec3 p) const noexcept;

 private:
  [[nodiscard]] std::size_t index(IVec3 c) const noexcept { return cell_index(c, size_); }
  double leaf_mm_;
  Vec3 first_mm_;  // centre of the first leaf
  IVec3 size_;
  std::vector<float> depth_mm_;
  std::vector<bool> soft_;
};

}  // namespace cavum::scenarios
