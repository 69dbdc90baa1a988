// Removal of tissue by the coated head of a diamond point at one pose. How far the surface recedes is
// decided by the servo (v = X/τ · rpm/rpm_ref); here its shape becomes the shape of the head.
#pragma once

#include <vector>

#include "engine/base/pose.h"
#include "engine/instrument/diamond_point.h"
#include "engine/tooth/octree.h"

namespace cavum {

/// Where a head was carved last, to know what it has already done.
struct CarvedHead {
  Vec3 tip_mm;
  Mat3 rotation;
  int point = -1;  ///< of the tray; -1 = nothing carved yet, or not completely
};

/// Turns every leaf inside the head to air and raises the surface distance around it. Appends to `removed`
/// within its capacity; `last` is brought up to date. Returns false when room ran out (then part of the head was
/// not carved). A head that only moved on since `last` is carved on its leading side alone: behind it nothing
/// can change, for all heads are convex. `ease_mm` widens the distance field (not the labels) around the whole head,
/// for one that is clamped in its hole.
bool carve_head(Octree& tooth, const DiamondPoint& head, int point, Vec3 tip_mm, const Mat3& rotation, double ease_mm, CarvedHead& last,
                std::vector<RemovedLeaf>& removed) noexcept;

}  // namespace cavum
