// Settings of the handpiece, the device and the tick: what a school or a rig may choose beside
// tooth, burs and force model.
#pragma once

#include <string>

#include "engine/physics/force/safety.h"
#include "engine/physics/servo/tick.h"

namespace cavum {

/// Settings of the handpiece, the device and the tick. TOML text in a session: see `to_toml`.
struct ServoConfig {
  double tick_s = k_tick_s;
  double max_rpm = 200000.0;  ///< speed at a pedal pressed to the floor
  double spin_up_s = 0.15;    ///< time constant of the handpiece's speed
  double position_quantum_mm =
      0.0;              ///< step of the device's encoder in the positions it reports; 0 = exact
  SafetyLimits limits;  ///< of the haptic device
};
[[nodiscard]] std::string to_toml(const ServoConfig& config);
/// Throws Error(where, ...) on anything missing, unknown or out of range.
[[nodiscard]] ServoConfig parse_servo_config(const std::string& text, const std::string& where);

}  // namespace cavum
