// The handpiece: how fast the diamond point turns under the pedal. A turbine follows its pedal with a lag, and stops at once when nobody
// knows where the pedal is.
#pragma once

#include <cstdint>

#include "engine/servo/servo_config.h"
#include "engine/servo/tick.h"

namespace cavum {

struct Handpiece {
  double rpm = 0.0;
};

/// One tick: rpm' = (pedal · max_rpm − rpm)/spin_up, implicit Euler. A pedal that is not known stops it in this tick.
void update_handpiece(const ServoConfig& config, const TickInput& input, Handpiece& state) noexcept;

/// Does it turn fast enough to cut?
[[nodiscard]] bool turns(const ServoConfig& config, const Handpiece& state) noexcept;

/// For state_hash.
[[nodiscard]] std::uint64_t hash_of(const Handpiece& state, std::uint64_t seed) noexcept;

}  // namespace cavum
