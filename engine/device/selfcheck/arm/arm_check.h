// A stylus checks itself, free and untouched, in less than a minute: friction and apparent mass
// along each axis, the step of its places, its rate. How each is measured, what it cannot see:
// docs/selfcheck.md.
#pragma once

#include <functional>
#include <string>

#include "engine/device/selfcheck/arm/arm_servo.h"
#include "engine/device/selfcheck/arm_figures.h"

namespace cavum {

/// Where a check stands, for the screen.
struct ArmProgress {
  Message words;       ///< what is done, or what the person shall do
  double share = 0.0;  ///< of the whole, 0..1
};

struct ArmCheckOptions {
  Vec3 home_mm;              ///< where it is checked, stylus frame
  double most_n = 1.0;       ///< no force is larger
  double patience_s = 20.0;  ///< for a person to bring it near home
  ArmClock clock = {};       ///< empty: the computer's
  std::function<void(const ArmProgress&)> tell = {};
  std::function<bool()> stop = {};
};

/// `stylus` speaks in its own frame (placement of identity), is ready, and nobody else reads it. It
/// ends without force. What speaks against the figures is their `doubt`. Throws Error when the
/// stylus is not ready, or falls silent meanwhile.
[[nodiscard]] ArmFigures check_arm(Stylus& stylus, const ArmCheckOptions& options);

}  // namespace cavum
