// From the model force to one that a sampled device can render. Explicit c·V at 1 kHz is unstable
// for the paper's c (docs/physics.md section 7); so k·X stands in parallel to a Maxwell branch,
// which equals the Voigt law at rest and at constant speed, and stays passive in between.
#pragma once

#include <cstdint>
#include <limits>

#include "engine/base/state_hash.h"
#include "engine/physics/force/voigt.h"

namespace cavum {

/// Source of the defaults: own closed-loop press, force sd 0.008-0.018 N in a closed-loop press.
struct RenderingModel {
  double kvc_n_per_mm = 0.7;  ///< spring of the Maxwell branch
  double filtered_damping_n_s_per_mm =
      0.002;                      ///< on the filtered speed, for the device's own ringing
  double speed_filter_s = 0.005;  ///< time constant of the speed estimate
  double drag_n_per_mm = 0.7;     ///< spring that friction is rendered through (force_terms.h);
                                  ///< from 1.5 on, two ticks of delay make it ring
};

struct RenderState {
  double branch_n = 0.0;    ///< z, force of the Maxwell branch
  double speed_mm_s = 0.0;  ///< filtered approach speed, positive = deeper
};
CAVUM_STATE(RenderState, branch_n, speed_mm_s)

/// Filtered approach speed after the tip moved `approach_mm` deeper in a tick of `dt_s`; 0 out of
/// contact.
void update_speed(const RenderingModel& model, RenderState& state, bool touching,
                  double approach_mm, double dt_s) noexcept;

/// Rendered force, N, never pulling: F = k·X + z + b·V + terms, z' = Kvc·V − (Kvc/(c−b))·z
/// integrated implicitly, b ≤ c. `terms_n` is what force terms add to the tissue's force. |z| is
/// held below (c−b)·`fastest_mm_s`, the most that the law allows for by the steps of a coarse
/// encoder (physics/servo/tip_estimate.h): otherwise z would relax with c/Kvc, 2.6 s for the
/// paper's c, and the tip creep on from step to step all that time. It only lets go of energy.
[[nodiscard]] double render_force_n(
    const RenderingModel& model, Viscoelastic tissue, RenderState& state, bool touching,
    double depth_mm, double approach_mm, double dt_s, double terms_n = 0.0,
    double fastest_mm_s = std::numeric_limits<double>::infinity()) noexcept;

}  // namespace cavum
