// How far the surface lies from where the recording has it, session by session: what the contact
// gives there, and a first estimate from what is left of the force. docs/physics.md, section 13,
// has the equation.
#pragma once

#include <vector>

#include "engine/lab/explain/model/scene.h"

namespace cavum::explain {

inline constexpr double k_farthest_surface_mm = 0.5;  ///< to either side; docs/physics.md

/// One row's part of the columns of k and c.
struct PressedRow {
  double spring_mm = 0, damper_mm_s = 0;
  double touching =
      0;  ///< 0..1, times relative_k: what one millimetre of offset adds to the column of k
};

/// Row `i`, had the surface been `delta_mm` nearer to the tool. The contact of `base` never pulls.
[[nodiscard]] PressedRow pressed_at(const Scene& scene, Eigen::Index i, double delta_mm, Base base);

/// Rows that share an offset: those of each session, or all when there are more than 12.
[[nodiscard]] std::vector<SessionRows> rows_of_one_surface(const Recording& recording);

/// Offsets that fit `scene.left_n` together with k and c, mm, one for each of
/// `rows_of_one_surface`: several estimates, coarse ones first, for a finer one is not always
/// better. 0 for a session without motion in air or without contact: there an offset of the surface
/// is one of the force. Empty when all sessions are like that.
[[nodiscard]] std::vector<std::vector<double>> surface_offsets_mm(const Scene& scene);

}  // namespace cavum::explain
