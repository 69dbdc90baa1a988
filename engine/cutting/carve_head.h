// Removal of tissue by the coated head of a diamond point at one pose. How far the surface recedes is
// decided by the servo (v = X/τ · rpm/rpm_ref); here its shape becomes the shape of the head.
#pragma once

#include <vector>

#include "engine/base/pose.h"
#include "engine/instrument/diamond_point.h"
#include "engine/tooth/octree.h"

namespace cavum {

/// Turns every leaf inside the head to air and raises the surface distance around it. Appends to `removed`
/// within its capacity. Returns false when room ran out (then part of the head was not carved).
bool carve_head(Octree& tooth, const DiamondPoint& point, Vec3 tip_mm, const Mat3& rotation, std::vector<RemovedLeaf>& removed) noexcept;

}  // namespace cavum
