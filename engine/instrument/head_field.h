// The signed distance to a coated head as a table over (r, z), because a carve asks for it at thousands of leaves
// and has 30 microseconds. Exact at the table's nodes; between them within a micrometre where the surface is smooth.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/instrument/profile.h"

namespace cavum {

class HeadField {
 public:
  HeadField() = default;
  /// `head` up to `cutting_length_mm`, where a flat top closes it; tabulated from the axis to `head_radius_mm` and `k_margin_mm` around.
  HeadField(const Profile& head, double cutting_length_mm, double head_radius_mm);

  /// Bilinear distances, mm, negative inside, at eight places: radius `r_mm` >= 0 and height `z_mm`. Outside the table that
  /// of its border, which is at least `k_margin_mm`.
  void distances_mm(const float* r_mm, const float* z_mm, float* out) const noexcept {
    float u[8], v[8], a[8], b[8], c[8], d[8];
    int i[8], j[8];
    for (int k = 0; k < 8; ++k) u[k] = std::min(r_mm[k] * k_per_mm, last_r_);
    for (int k = 0; k < 8; ++k) v[k] = std::min(std::max((z_mm[k] + k_margin_mm) * k_per_mm, 0.0f), last_z_);
    for (int k = 0; k < 8; ++k) i[k] = static_cast<int>(u[k]);
    for (int k = 0; k < 8; ++k) j[k] = static_cast<int>(v[k]);
    for (int k = 0; k < 8; ++k) {
      const float* at = table_.data() + j[k] * columns_ + i[k];
      a[k] = at[0];
      b[k] = at[1];
      c[k] = at[columns_];
      d[k] = at[columns_ + 1];
    }
    for (int k = 0; k < 8; ++k) {
      const float fu = u[k] - static_cast<float>(i[k]), fv = v[k] - static_cast<float>(j[k]);
      const float low = a[k] + (b[k] - a[k]) * fu, high = c[k] + (d[k] - c[k]) * fu;
      out[k] = low + (high - low) * fv;
    }
  }

 private:
  static constexpr float k_per_mm = 80.0f;  // nodes, 0.0125 mm apart
  static constexpr float k_margin_mm = 0.4f;

  std::vector<float> table_;  // [z][r], mm
  int columns_ = 0;
  float last_r_ = 0, last_z_ = 0;  // index just before the last node's
};

}  // namespace cavum
