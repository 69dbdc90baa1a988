// Voigt contact force of one tissue mixture: F = k·X + c·V while in contact, never pulling.
// Source: HAP-DENT paper, equations 1 to 3. X and V are measured along the contact normal.
#pragma once

#include <algorithm>

namespace cavum {

/// Spring and damper of a tissue, or of the mixture that a bur touches.
struct Viscoelastic {
  double stiffness_n_per_mm = 0.0;  ///< k, 0 for pulp (a cavity)
  double damping_n_s_per_mm = 0.0;  ///< c = 2·h·√k with h = 1 in the `paper` set
};

/// Model force, N, at penetration `depth_mm` (0 = touching) and approach speed `speed_mm_s`
/// (positive = deeper). `terms_n` is what force terms add to the tissue's force (force_terms.h).
/// Returns 0 out of contact and whenever the sum would pull the tool inwards.
[[nodiscard]] constexpr double voigt_force_n(Viscoelastic tissue, double depth_mm,
                                             double speed_mm_s, double terms_n = 0.0) noexcept {
  if (!(depth_mm > 0.0)) return 0.0;
  return std::max(
      0.0, tissue.stiffness_n_per_mm * depth_mm + tissue.damping_n_s_per_mm * speed_mm_s + terms_n);
}

}  // namespace cavum
