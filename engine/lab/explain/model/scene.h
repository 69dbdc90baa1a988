// What a mechanism may look at: the motion as estimated, the base force that the engine's law gives
// on it, who was in contact, and the other columns. One scene is one recording (or one motion that
// it leaves possible) seen with one pair of k and c.
#pragma once

#include <algorithm>

#include "engine/base/shared_value.h"
#include "engine/lab/explain/recording/motion.h"
#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

/// k and c of the base law F = max(0, k X + c V) in contact, zero in air.
struct Base {
  double k_n_per_mm = 0.0, c_n_s_per_mm = 0.0;
};

/// All series of shape [rows].
struct Scene {
  const Recording* recording = nullptr;  ///< sessions, times and columns; not null
  Shared<Motion> motion;
  Base base;
  Series dt_s;
  Series touching;  ///< 0..1: probability that X > 0, given the uncertainty of X
  Series active;    ///< touching, and the force of the contact is above zero (not clipped by "never
                    ///< pulls")
  Series spring_mm;    ///< X · active (times relative_k): the column of k
  Series damper_mm_s;  ///< V · active (times relative_c): the column of c
  Series force_n;      ///< base force F_sim
  Series spinning;     ///< 1 where spindle_rpm > 0; all 0 without that column
  Series weight;       ///< 0..1: less where the position leaves the base force uncertain, and near
                       ///< contact transitions
  Series left_n;       ///< force that base and causes leave; empty outside of a view with products
  std::vector<double>
      lines_hz;  ///< lines found in the residual in contact, candidates of chatter (lines.h)
  std::vector<double> lines_in_air_hz;  ///< and anywhere, candidates of interference
};

/// Of relative_k or relative_c in a row; 1 where all is one tissue.
[[nodiscard]] inline double relative_at(const Series& relative, Eigen::Index row) {
  return relative.size() > 0 ? relative[row] : 1.0;
}

/// Everything but `weight` follows from motion and base. `noise_sd_n` and `rho` (correlation from
/// row to row) describe the noise that the weights are measured against: an error of position lasts
/// as long as the encoder stands still, so it counts as much as many rows of independent noise.
/// `pressed_n`: force of all that acts inside the contact, before max(0, ...), shape [rows];
/// nullptr = the base alone. `uncertain_n2`: variance that the position leaves in the force of the
/// causes, shape [rows]; nullptr = none.
[[nodiscard]] Scene make_scene(const Recording& recording, const Shared<Motion>& motion, Base base,
                               double noise_sd_n, double rho, const Series* pressed_n = nullptr,
                               const Series* uncertain_n2 = nullptr);
/// Contact is lost where `pressed_n` would pull: sets `active` and the columns of k and c, and
/// nothing else. nullptr = nowhere.
void never_pull(Scene& scene, const Series* pressed_n);

/// Probability that a penetration known as `x_mm` with this standard deviation is above zero.
[[nodiscard]] double touching_probability(double x_mm, double sd_mm) noexcept;

/// Largest penetration, mm, > 0.
[[nodiscard]] inline double deepest_mm(const Scene& scene) {
  return std::max(1e-6, scene.spring_mm.maxCoeff());
}

}  // namespace cavum::explain
