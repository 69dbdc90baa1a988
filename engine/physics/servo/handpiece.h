// The handpiece: how fast the bur turns under the pedal, and under what it grinds. It follows its
// pedal with a lag, and stops at once when nobody knows where the pedal is. With a drive
// (force_model.h) it slows down under load and stalls.
#pragma once

#include <cstdint>

#include "engine/base/state_hash.h"
#include "engine/physics/force/force_model.h"
#include "engine/physics/servo/servo_config.h"
#include "engine/physics/servo/tick.h"

namespace cavum {

struct Handpiece {
  double rpm = 0.0;
  double load_n_mm = 0.0;  ///< torque of what it grinds, from the tick before; 0 without a drive
};
CAVUM_STATE(Handpiece, rpm, load_n_mm)

/// One tick, implicit Euler. A pedal that is not known stops it in this tick. Without a drive: rpm'
/// = (pedal · max_rpm − rpm)/spin_up. With one: rpm' = max_rpm/spin_up · (clamp((pedal · max_rpm −
/// rpm)/slip, −1, 1) − load/torque), never below 0: the rotor of which spin_up is the time from
/// standstill to max_rpm under the whole torque.
void update_handpiece(const ServoConfig& config, const HandpieceDrive& drive,
                      const TickInput& input, Handpiece& state) noexcept;

/// Does it turn fast enough to cut?
[[nodiscard]] bool turns(const ServoConfig& config, const Handpiece& state) noexcept;

}  // namespace cavum
