#include "engine/physics/servo/tip_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cavum {
namespace {

constexpr double k_mm_per_nm = 1e-6;

double& part(Vec3& v, std::size_t axis) noexcept { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

}  // namespace

TipEstimate make_tip_estimate(std::array<std::int32_t, 3> reading_nm) noexcept {
  TipEstimate state;
  for (std::size_t i = 0; i < 3; ++i) {
    state.step_nm[i] = reading_nm[i];
    part(state.tip_mm, i) = reading_nm[i] * k_mm_per_nm;
  }
  return state;
}

void update_tip_estimate(TipEstimate& state, std::array<std::int32_t, 3> reading_nm,
                         std::int64_t tick, double quantum_mm, double dt_s) noexcept {
  const double half = 0.5 * quantum_mm;
  for (std::size_t i = 0; i < 3; ++i) {
    double& speed = part(state.speed_mm_s, i);
    const double reading_mm = reading_nm[i] * k_mm_per_nm;
    const std::int64_t travel_nm = reading_nm[i] - state.step_nm[i];
    if (std::fabs(static_cast<double>(travel_nm) * k_mm_per_nm) > half) {
      const bool onward = (travel_nm > 0) == (state.travel_nm[i] > 0) && state.travel_nm[i] != 0;
      state.step_ticks[i] = std::max<std::int64_t>(1, tick - state.step_tick[i]);
      state.step_tick[i] = tick;
      state.step_nm[i] = reading_nm[i];
      state.travel_nm[i] = travel_nm;
      speed = onward ? static_cast<double>(travel_nm) * k_mm_per_nm /
                           (static_cast<double>(state.step_ticks[i]) * dt_s)
                     : 0.0;
    }
    double& tip = part(state.tip_mm, i);
    tip = std::clamp(tip + speed * dt_s, reading_mm - half, reading_mm + half);
  }
}

double fastest_mm_s(const TipEstimate& state, Vec3 direction, std::int64_t tick, double quantum_mm,
                    double dt_s) noexcept {
  if (!(quantum_mm > 0.0)) return std::numeric_limits<double>::infinity();
  double fastest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (state.step_ticks[i] == 0) continue;  // it has not moved yet
    const double between_s = static_cast<double>(state.step_ticks[i]) * dt_s;
    const double late =
        between_s / std::max(between_s, static_cast<double>(tick - state.step_tick[i]) * dt_s);
    fastest += std::fabs(part(direction, i)) * 2.0 *
               std::fabs(static_cast<double>(state.travel_nm[i])) * k_mm_per_nm / between_s *
               (late * late);
  }
  return fastest;
}

}  // namespace cavum
