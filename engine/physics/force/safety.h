// What protects the hand and the device: a clamp, a slew limit, a budget for sustained force, a
// watchdog for a silent stylus, and a last gate that no NaN passes. Works on the force vector just
// before the device.
#pragma once

#include <cstdint>

#include "engine/base/state_hash.h"
#include "engine/base/vec.h"

namespace cavum {

/// Limits of the haptic device; defaults are those of the PHANTOM Omni (docs/physics.md section
/// 10).
struct SafetyLimits {
  double peak_n = 3.3;
  double continuous_n = 0.88;   ///< may be rendered without end
  double slew_n_per_s = 700.0;  ///< fastest change of the force; at least peak_n / watchdog_s, or
                                ///< the fade could not keep its time
  double sustained_budget_n_s =
      30.0;  ///< force above the continuous rating times its duration, refilled when below
  double watchdog_s =
      0.005;  ///< without a fresh pose for longer, the force fades to zero in as long again
};

struct SafetyState {
  Vec3 force_n;  ///< last one given out
  double used_budget_n_s = 0;
  double silent_s = 0;  ///< since the last fresh pose
};
CAVUM_STATE(SafetyState, force_n, used_budget_n_s, silent_s)

/// The force that may go to the device. Sets bits of TickNotice in `notices`.
[[nodiscard]] Vec3 make_safe(const SafetyLimits& limits, SafetyState& state, Vec3 wanted_n,
                             bool fresh, double dt_s, std::uint16_t& notices) noexcept;

}  // namespace cavum
