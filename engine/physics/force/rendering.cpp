#include "engine/physics/force/rendering.h"

#include <array>

namespace cavum {

void update_speed(const RenderingModel& model, RenderState& state, bool touching,
                  double approach_mm, double dt_s) noexcept {
  if (!touching) {
    state.speed_mm_s = 0.0;
    return;
  }
  state.speed_mm_s +=
      (approach_mm / dt_s - state.speed_mm_s) * (dt_s / (model.speed_filter_s + dt_s));
}

double render_force_n(const RenderingModel& model, Viscoelastic tissue, RenderState& state,
                      bool touching, double depth_mm, double approach_mm, double dt_s,
                      double terms_n, double fastest_mm_s) noexcept {
  if (!touching) {
    state.branch_n = 0.0;
    return 0.0;
  }
  // the small damper on the filtered speed is taken out of c, so that both together make the Voigt
  // law
  const double calm = std::min(model.filtered_damping_n_s_per_mm, tissue.damping_n_s_per_mm);
  const double c = tissue.damping_n_s_per_mm - calm;
  if (c > 0.0) {  // implicit Euler: z = (z + Kvc·dX) / (1 + Kvc·dt/c)
    const double most_n = c * fastest_mm_s;
    state.branch_n = std::clamp(
        (state.branch_n + model.kvc_n_per_mm * approach_mm) * (c / (c + model.kvc_n_per_mm * dt_s)),
        -most_n, most_n);
  } else {
    state.branch_n = 0.0;
  }
  return std::max(0.0, tissue.stiffness_n_per_mm * depth_mm + state.branch_n +
                           calm * state.speed_mm_s + terms_n);
}

}  // namespace cavum
