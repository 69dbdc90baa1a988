// The occlusal face of a tooth with a seed, as heights over (x, y): the highest of all cusps and
// marginal ridges. Where two of them are equally high lies a valley, so grooves get their winding
// course from the ridges themselves; fissures are cut into the bottom of the valleys, with a V
// section. Worked out once on a fine lattice and interpolated from there.
#pragma once

#include <vector>

#include "engine/tooth/make/tooth_plan.h"

namespace cavum {

/// What lies over a place of the occlusal face. mm.
struct Relief {
  double height_mm;   // without fissures
  double fissure_mm;  // depth of the fissure below that, along z, >= 0
  double slant;  // 1 / sqrt(1 + slope²) with fissures: turns a distance along z into one along the
                 // normal
  double plain_slant;  // the same without fissures, averaged over half a millimetre
  double groove_mm;    // how deep a groove cuts into the wall here, >= 0
};

class OcclusalRelief {
 public:
  /// For |x| <= half_x_mm, |y| <= half_y_mm; constant beyond.
  OcclusalRelief(const ToothPlan& plan, double half_x_mm, double half_y_mm);
  /// Continuous in x and y.
  [[nodiscard]] Relief at(double x, double y) const noexcept;

 private:
  static constexpr double k_step_mm = 0.03;
  void work_out_slants();
  [[nodiscard]] std::size_t index(int i, int j) const noexcept {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) +
           static_cast<std::size_t>(i);
  }

  int nx_, ny_;
  double low_x_, low_y_;
  std::vector<Relief> relief_;
};

}  // namespace cavum
