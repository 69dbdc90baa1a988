#include "engine/physics/force/safety.h"

#include <algorithm>
#include <array>

#include "engine/physics/force/notices.h"

namespace cavum {

Vec3 make_safe(const SafetyLimits& limits, SafetyState& state, Vec3 wanted_n, bool fresh,
               double dt_s, std::uint16_t& notices) noexcept {
  if (!is_finite(wanted_n)) {
    wanted_n = {};
    notices |= k_notice_not_finite;
  }
  state.silent_s = fresh ? 0.0 : state.silent_s + dt_s;
  if (state.silent_s > limits.watchdog_s) {
    wanted_n = wanted_n * std::clamp(2.0 - state.silent_s / limits.watchdog_s, 0.0, 1.0);
    notices |= k_notice_stale_stylus;
  }
  double cap_n = limits.peak_n;
  const double given_n = length(state.force_n);
  state.used_budget_n_s = std::clamp(state.used_budget_n_s + (given_n - limits.continuous_n) * dt_s,
                                     0.0, limits.sustained_budget_n_s);
  // the last tenth of the budget narrows the cap, so that the force sinks instead of dropping
  const double left = 1.0 - state.used_budget_n_s / limits.sustained_budget_n_s;
  if (left < 0.1) {
    cap_n = limits.continuous_n + (limits.peak_n - limits.continuous_n) * (left / 0.1);
    if (length(wanted_n) > cap_n) notices |= k_notice_force_budget;
  }
  const double wanted = length(wanted_n);
  if (wanted > cap_n) {
    wanted_n = wanted_n * (cap_n / wanted);
    notices |= k_notice_force_clamped;
  }
  const Vec3 change = wanted_n - state.force_n;
  const double most = limits.slew_n_per_s * dt_s, step = length(change);
  if (step > most) {
    wanted_n = state.force_n + change * (most / step);
    notices |= k_notice_slew_limited;
  }
  state.force_n = wanted_n;
  return wanted_n;
}

}  // namespace cavum
