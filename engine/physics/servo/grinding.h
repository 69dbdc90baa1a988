// Grinding by pressure: how fast a turning coated head sinks into what it is pressed on, and what
// that takes to turn it. Source: Preston, J. Soc. Glass Technology 1927: recession = K · pressure ·
// speed. For a rigid head that recedes by h along n every place with normal at θ must recede by h
// cosθ, so its pressure is h cosθ/(K ω r); their sum along n is the force. docs/physics.md
// section 8.
#pragma once

#include "engine/physics/contact/touched_means.h"

namespace cavum {

/// Recession along the contact normal, mm/s: h = F ω/S, F the head's share of `pressing_n`, ω = 2π
/// rpm/60, S = Σ A w cos²θ/(K r). Implicit in F, which falls by `stiffness_n_per_mm` · h in a tick:
/// a touch of no area goes as far as the force lasts, and no further. 0 when nothing is ground.
[[nodiscard]] double ground_mm_s(const GrindingSums& sums, double pressing_n,
                                 double stiffness_n_per_mm, double rpm, double dt_s) noexcept;

/// Torque that resists the turning, N·mm: T = μ F Q/S, Q = Σ A w cosθ/K and μ = `force_ratio`,
/// force along the sliding over force into the surface. Q/S is the radius at which the force acts
/// in the mean. Friction: a head that has stalled is held by up to as much.
[[nodiscard]] double grinding_torque_n_mm(const GrindingSums& sums, double pressing_n,
                                          double force_ratio) noexcept;

}  // namespace cavum
