#include "engine/servo/handpiece.h"

#include "engine/base/hash.h"

namespace cavum {
namespace {

// Share of the pedal's way: a foot that only rests on it must not drill.
constexpr double k_dead_travel = 0.02;
// Share of the full speed, 2000 of 200,000 rpm: an exponential run-down would never end otherwise.
constexpr double k_still_share = 0.01;

}  // namespace

void update_handpiece(const ServoConfig& config, const TickInput& input, Handpiece& state) noexcept {
  if ((input.flags & k_pedal_fresh) == 0) {
    state.rpm = 0.0;
    return;
  }
  const double pedal = input.pedal();
  const double wanted = pedal > k_dead_travel ? pedal * config.max_rpm : 0.0;
  state.rpm += (wanted - state.rpm) * (config.tick_s / (config.spin_up_s + config.tick_s));
  if (wanted == 0.0 && !turns(config, state)) state.rpm = 0.0;
}

bool turns(const ServoConfig& config, const Handpiece& state) noexcept { return state.rpm >= k_still_share * config.max_rpm; }

std::uint64_t hash_of(const Handpiece& state, std::uint64_t seed) noexcept { return fast_hash(&state.rpm, sizeof state.rpm, seed); }

}  // namespace cavum
