#include "engine/device/simulated_omni.h"

#include <algorithm>
#include <cmath>

namespace cavum {
namespace {

constexpr int k_steps = 4;

double to_grid(double value, double quantum) noexcept {
  return quantum > 0 ? std::floor(value / quantum + 0.5) * quantum : value;
}

}  // namespace

OmniState make_omni_state(Vec3 position_mm) { return {position_mm, {}, {}, position_mm}; }

Vec3 advance_omni(const OmniModel& omni, const HandModel& hand, OmniState& state, Vec3 commanded_n,
                  Vec3 intended_mm, double dt_s) noexcept {
  const double size = length(commanded_n);
  const Vec3 motor =
      size > omni.saturation_n ? commanded_n * (omni.saturation_n / size) : commanded_n;
  const auto delay = static_cast<std::size_t>(std::clamp(omni.delay_ticks, 0, 3));
  state.queued_n[delay] = motor;
  const Vec3 force = state.queued_n[0];
  for (std::size_t i = 0; i + 1 < state.queued_n.size(); ++i)
    state.queued_n[i] = state.queued_n[i + 1];

  const double h = dt_s / k_steps;
  const double per_mass = 1000.0 / (omni.mass_kg + hand.mass_kg);  // N to mm/s²
  const Vec3 intended_speed = (intended_mm - state.last_intended_mm) / dt_s;
  for (int i = 0; i < k_steps; ++i) {
    const Vec3 wanted =
        state.last_intended_mm + (intended_mm - state.last_intended_mm) * ((i + 1.0) / k_steps);
    const Vec3 push = force + (wanted - state.position_mm) * hand.stiffness_n_per_mm +
                      intended_speed * hand.damping_n_s_per_mm;
    // dampers and the spring's growth implicitly, so that a stiff hand cannot make the simulation
    // itself ring
    const double slow =
        1.0 + h * per_mass *
                  (hand.damping_n_s_per_mm + omni.viscous_n_s_per_mm + h * hand.stiffness_n_per_mm);
    Vec3 v = (state.velocity_mm_s + push * (h * per_mass)) / slow;
    const double speed = length(v), lost = h * per_mass * omni.coulomb_n /
                                           slow;  // Coulomb friction stops, never reverses
    v = speed > lost ? v * (1.0 - lost / speed) : Vec3{};
    state.velocity_mm_s = v;
    state.position_mm += v * h;
  }
  state.last_intended_mm = intended_mm;
  const Vec3 p = state.position_mm;
  return {to_grid(p.x, omni.quantum_mm), to_grid(p.y, omni.quantum_mm),
          to_grid(p.z, omni.quantum_mm)};
}

}  // namespace cavum
