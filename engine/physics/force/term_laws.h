// The formulae of the force terms, one function each. The terms that an exam feels and the columns that `explain` fits call
// these same functions, so that what is found is what is switched on. Sources: docs/physics.md section 6.
// Arithmetic and det_math.h only: the same bits everywhere.
#pragma once

#include <algorithm>

#include "engine/base/det_math.h"

namespace cavum {

/// Part of a dry friction at speed `v_mm_s`, -1 … 1: tanh(V/v0), v0 > 0.
[[nodiscard]] constexpr double sliding_share(double v_mm_s, double v0_mm_s) noexcept { return det_tanh(v_mm_s / v0_mm_s); }

/// Part of the static friction that is left at speed `v_mm_s`, 0 … 1: e^(−(V/vs)²), vs > 0.
[[nodiscard]] constexpr double static_share(double v_mm_s, double vs_mm_s) noexcept {
  const double u = v_mm_s / vs_mm_s;
  return det_exp(-u * u);
}

/// Depth in a layer that begins at `d0_mm`: (X − d0)₊, mm.
[[nodiscard]] constexpr double layer_mm(double x_mm, double d0_mm) noexcept { return std::max(0.0, x_mm - d0_mm); }

/// −k α X², N: what is added to k X so that the stiffness is k (1 − α X).
[[nodiscard]] constexpr double graded_n(double k_n_per_mm, double alpha_per_mm, double x_mm) noexcept {
  return -k_n_per_mm * alpha_per_mm * x_mm * x_mm;
}

/// X^m − X, X >= 0 in mm.
[[nodiscard]] constexpr double power_beyond_mm(double x_mm, double m) noexcept { return det_pow(x_mm, m) - x_mm; }

/// |V|^n sign V − V, V in mm/s.
[[nodiscard]] constexpr double feed_beyond_mm_s(double v_mm_s, double n) noexcept {
  const double size = det_pow(v_mm_s < 0 ? -v_mm_s : v_mm_s, n);
  return (v_mm_s < 0 ? -size : size) - v_mm_s;
}

/// X/(1 + k X/Fs) − X, mm: how far a spring that softens with the force gives way; Fs > 0, N, infinite = not at all.
[[nodiscard]] constexpr double softened_mm(double x_mm, double k_n_per_mm, double fs_n) noexcept {
  const double part = k_n_per_mm * x_mm / fs_n;
  return -x_mm * (part / (1.0 + part));
}

/// Stretch of a Maxwell branch after the tip moved by `moved_mm` at constant speed within u = dt/τ: z' = V − z/τ, exact for any u >= 0.
[[nodiscard]] constexpr double relaxed_mm(double z_mm, double moved_mm, double u) noexcept {
  const double kept = det_exp(-u);
  return z_mm * kept + moved_mm * (u > 0.0 ? (1.0 - kept) / u : 1.0);
}

/// First-order lag y' = (g − y)/τ after a time of u·τ in which g went straight from `from` to `to`; exact for any u > 0.
[[nodiscard]] constexpr double lagged_n(double y, double from, double to, double u) noexcept {
  const double behind = (to - from) / u;
  return to - behind + (y - from + behind) * det_exp(-u);
}

/// Bouc-Wen with n = 1 after the tip moved by `moved_mm`: z' = V − ((1 − γ) |V| z + γ V |z|)/d, exact for a way of any length.
/// |z| stays below d > 0, mm. γ = 0: Dahl's model; γ = 1/2: unloading is straight. 0 <= γ <= 1/2.
[[nodiscard]] constexpr double loop_mm(double z_mm, double moved_mm, double d_mm, double gamma) noexcept {
  const double sign = moved_mm < 0 ? -1.0 : 1.0;
  double way = sign * moved_mm, y = sign * z_mm;  // along the motion
  if (y < 0.0) {                                  // unloading: y' = 1 − r y
    const double r = (1.0 - 2.0 * gamma) / d_mm;
    const double to_zero = r > 0.0 ? det_log(1.0 - r * y) / r : -y;
    if (way < to_zero) return sign * (r > 0.0 ? 1.0 / r + (y - 1.0 / r) * det_exp(-r * way) : y + way);
    way -= to_zero;
    y = 0.0;
  }
  return sign * (d_mm + (y - d_mm) * det_exp(-way / d_mm));
}

/// Place of a tip with play: it stays where it was until the drive at `x_mm` has gone `behind_mm` past it, or `ahead_mm` back over it.
[[nodiscard]] constexpr double played_mm(double tip_mm, double x_mm, double behind_mm, double ahead_mm) noexcept {
  return std::clamp(tip_mm, x_mm - behind_mm, x_mm + ahead_mm);
}

/// sin(2π·turns): a line in the spectrum, for run-out and chatter.
[[nodiscard]] constexpr double line_at(double turns) noexcept { return det_sincos(2 * k_pi * turns).sin; }

/// Twice the angle of approach as cos and sin, from degrees.
[[nodiscard]] constexpr SinCos twice_angle(double deg) noexcept { return det_sincos(2.0 * deg * (k_pi / 180.0)); }
/// cos 2(φ − φ0), from the two of φ and of φ0.
[[nodiscard]] constexpr double turned_share(SinCos phi, SinCos phi0) noexcept { return phi.cos * phi0.cos + phi.sin * phi0.sin; }

/// Force, N, that a worn bur adds to `voigt_n` for each part w per mm³: F W.
[[nodiscard]] constexpr double worn_n(double voigt_n, double removed_mm3) noexcept { return voigt_n * removed_mm3; }
/// Force, N, that water adds for a fraction of 1: F wet.
[[nodiscard]] constexpr double watered_n(double voigt_n, double wet) noexcept { return voigt_n * wet; }
/// Force, N, that warmth adds for a softening of 1 per K: −F ΔT.
[[nodiscard]] constexpr double warmed_n(double voigt_n, double warmer_k) noexcept { return -voigt_n * warmer_k; }

}  // namespace cavum
