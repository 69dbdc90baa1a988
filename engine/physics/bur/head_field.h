// The signed distance to a coated head as a table over (r, z), because a carve asks for it at
// thousands of leaves and has 30 microseconds. Exact at the table's nodes; between them within a
// micrometre where the surface is smooth.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "engine/physics/bur/profile.h"

namespace cavum {

class HeadField {
 public:
  HeadField() = default;
  /// `head` up to `cutting_length_mm`, where a flat top closes it; tabulated from the axis to
  /// `head_radius_mm` and `k_margin_mm` around.
  HeadField(const Profile& head, double cutting_length_mm, double head_radius_mm);

  /// Bilinear distances, mm, negative inside, at eight places: radius `r_mm` >= 0 and height
  /// `z_mm`. Outside the table that of its border, which is at least `k_margin_mm`.
  void distances_mm(const float* r_mm, const float* z_mm, float* out) const noexcept {
    four_distances_mm(r_mm, z_mm, out);
    four_distances_mm(r_mm + 4, z_mm + 4, out + 4);
  }

 private:
  static constexpr float k_per_mm = 80.0f;  // nodes, 0.0125 mm apart
  static constexpr float k_margin_mm = 0.4f;
  // Vector types, of which every compiler and machine makes the same.
  using Four = float __attribute__((vector_size(16)));
  using FourWhole = std::int32_t __attribute__((vector_size(16)));
  using TwoPairs = std::uint64_t __attribute__((vector_size(16)));

  /// Two neighbours along r, as the bits of one number.
  [[nodiscard]] std::uint64_t pair_at(std::int32_t node) const noexcept {
    std::uint64_t pair;
    std::memcpy(&pair, table_.data() + node, sizeof pair);
    return pair;
  }
  void four_distances_mm(const float* r_mm, const float* z_mm, float* out) const noexcept {
    Four u, v;
    std::memcpy(&u, r_mm, sizeof u);
    std::memcpy(&v, z_mm, sizeof v);
    u = u * k_per_mm;
    u = u < last_r_ ? u : Four{} + last_r_;
    v = (v + k_margin_mm) * k_per_mm;
    v = v > 0.0f ? v : Four{};
    v = v < last_z_ ? v : Four{} + last_z_;
    const Four i = __builtin_convertvector(__builtin_convertvector(u, FourWhole), Four),
               j = __builtin_convertvector(__builtin_convertvector(v, FourWhole), Four);
    const FourWhole node = __builtin_convertvector(j * static_cast<float>(columns_) + i,
                                                   FourWhole);  // exact below 2^24 nodes
    const auto along_r = [&](std::int32_t rows, Four& at, Four& next) {
      const auto first = std::bit_cast<Four>(
                     TwoPairs{pair_at(node[0] + rows), pair_at(node[1] + rows)}),
                 last = std::bit_cast<Four>(
                     TwoPairs{pair_at(node[2] + rows), pair_at(node[3] + rows)});
      at = __builtin_shufflevector(first, last, 0, 2, 4, 6);
      next = __builtin_shufflevector(first, last, 1, 3, 5, 7);
    };
    Four a, b, c, d;
    along_r(0, a, b);
    along_r(columns_, c, d);
    const Four fu = u - i, fv = v - j, low = a + (b - a) * fu, high = c + (d - c) * fu,
               distance = low + (high - low) * fv;
    std::memcpy(out, &distance, sizeof distance);
  }

  std::vector<float> table_;  // [z][r], mm
  int columns_ = 0;
  float last_r_ = 0, last_z_ = 0;  // index just before the last node's
};

}  // namespace cavum
