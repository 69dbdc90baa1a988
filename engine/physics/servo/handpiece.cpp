#include "engine/physics/servo/handpiece.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/physics/contact/tuning.h"

namespace cavum {

using namespace tuning;

namespace {

/// Speed after a tick under a drive. The line of torque over speed is taken implicitly: a steep one
/// would swing from tick to tick.
double driven_rpm(const ServoConfig& config, const HandpieceDrive& drive, double wanted_rpm,
                  const Handpiece& state) noexcept {
  const double dt_s = config.tick_s, loaded = state.load_n_mm / drive.torque_n_mm,
               slip = drive.slip_rpm;
  const double rpm =
      (state.rpm * config.spin_up_s + dt_s * config.max_rpm * (wanted_rpm / slip - loaded)) /
      (config.spin_up_s + dt_s * config.max_rpm / slip);
  if (std::fabs(wanted_rpm - rpm) <= slip) return std::max(0.0, rpm);
  const double most = wanted_rpm > rpm ? 1.0 : -1.0;
  return std::max(0.0, state.rpm + (most - loaded) * config.max_rpm *
                                       (dt_s / std::max(config.spin_up_s, dt_s)));
}

}  // namespace

void update_handpiece(const ServoConfig& config, const HandpieceDrive& drive,
                      const TickInput& input, Handpiece& state) noexcept {
  if ((input.flags & k_pedal_fresh) == 0) {
    state.rpm = 0.0;
    return;
  }
  const double pedal = input.pedal();
  const double wanted = pedal > k_dead_travel ? pedal * config.max_rpm : 0.0;
  if (drive.torque_n_mm > 0.0)
    state.rpm = driven_rpm(config, drive, wanted, state);
  else
    state.rpm += (wanted - state.rpm) * (config.tick_s / (config.spin_up_s + config.tick_s));
  if (wanted == 0.0 && !turns(config, state)) state.rpm = 0.0;
}

bool turns(const ServoConfig& config, const Handpiece& state) noexcept {
  return state.rpm >= k_still_share * config.max_rpm;
}

}  // namespace cavum
