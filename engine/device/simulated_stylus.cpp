#include "engine/device/simulated_stylus.h"

#include <algorithm>
#include <cmath>

namespace cavum {

StylusFacts simulated_facts(const OmniModel& omni) {
  return {.id = "simulated",
          .name = msg("simulated Omni in a simulated hand"),
          .position_quantum_mm = omni.quantum_mm,
          .peak_n = omni.saturation_n,
          .continuous_n = 0.88,
          .rate_hz = 1000.0,
          .reach_mm = 35.0,
          .measures_direction = false};
}

DeviceReading SimulatedStylus::read(double elapsed_s) {
  constexpr int k_max_steps = 1000;
  const int steps =
      std::clamp(static_cast<int>(std::floor(elapsed_s / tick_s_ + 0.5)), 1, k_max_steps);
  HandIntent intent;
  Vec3 tip;
  for (int i = 0; i < steps; ++i) {
    time_s_ += tick_s_;
    intent = intent_(time_s_);
    tip =
        advance_omni(omni_, hand_, state_, cut_.load(std::memory_order_acquire) ? Vec3{} : force_n_,
                     intent.tip_mm, tick_s_);
  }
  readings_.fetch_add(steps, std::memory_order_relaxed);
  return {{tip, {}}, intent.pedal, k_stylus_fresh | k_pedal_fresh, 0};
}

void SimulatedStylus::send_force(Vec3 force_n) {
  force_n_ = force_n;
  if (length(force_n) > omni_.saturation_n) forces_cut_.fetch_add(1, std::memory_order_relaxed);
  cut_.store(false, std::memory_order_release);
}

StylusHealth SimulatedStylus::health() const {
  StylusHealth h;
  h.readings = readings_.load(std::memory_order_relaxed);
  h.plugged_in = 1;
  h.forces_cut = forces_cut_.load(std::memory_order_relaxed);
  h.mean_period_s = h.longest_gap_s = tick_s_;
  return h;
}

}  // namespace cavum
