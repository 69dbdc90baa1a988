// The figures of the HAP-DENT paper that the virtual testing machine is compared with. What can be
// computed from them is computed here, never typed in.
#pragma once

#include <cmath>

namespace cavum {

inline constexpr double k_paper_speed_mm_s = 0.25;    ///< crosshead
inline constexpr double k_paper_slope_mm = 0.505;     ///< of eq. 6, F = 0.505 k + 0.673
inline constexpr double k_paper_intercept_n = 0.673;  ///< of eq. 6, at k = 0
inline constexpr double k_paper_tooth_n = 1.071;      ///< mean cutting force of a real tooth
inline constexpr double k_paper_k_n_per_mm = 0.8;     ///< chosen for hard tissue
inline constexpr double k_paper_damping_h = 1.0;      ///< h of eq. 5

/// Eq. 5 with the paper's "m = 1": c = 2 h √k, N·s/mm.
[[nodiscard]] inline double paper_damping_n_s_per_mm(double k_n_per_mm) noexcept {
  return 2.0 * k_paper_damping_h * std::sqrt(k_n_per_mm);
}
/// Critical damping of a stylus of `mass_kg` on k, with the units kept: c = 2 √(k m), N·s/mm.
[[nodiscard]] inline double consistent_damping_n_s_per_mm(double k_n_per_mm,
                                                          double mass_kg) noexcept {
  return 2.0 * std::sqrt(1000.0 * k_n_per_mm * mass_kg) / 1000.0;
}
/// Eq. 6, N.
[[nodiscard]] constexpr double paper_force_n(double k_n_per_mm) noexcept {
  return k_paper_slope_mm * k_n_per_mm + k_paper_intercept_n;
}
/// Eq. 6 the other way: the k at which a cube is cut with `force_n`.
[[nodiscard]] constexpr double paper_stiffness_n_per_mm(double force_n) noexcept {
  return (force_n - k_paper_intercept_n) / k_paper_slope_mm;
}

}  // namespace cavum
