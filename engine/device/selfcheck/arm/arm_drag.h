// Friction and weight along one axis: the arm is dragged slowly forth and back through the same
// places by a virtual spring. Work done forth and back over the same way, W = ∮ F dx, is lost to
// friction alone: gravity, springs and cable ripple give back what they took, and mass does not
// count.
#pragma once

#include "engine/device/selfcheck/arm/arm_servo.h"
#include "engine/device/selfcheck/arm_figures.h"

namespace cavum {

/// Fills friction, its error and weight of `axis`; leaves the arm at home, leaning on its weight.
/// Throws ArmStopped when it does not follow.
void drag_axis(ArmServo& servo, std::size_t axis, ArmFigures& figures);

}  // namespace cavum
