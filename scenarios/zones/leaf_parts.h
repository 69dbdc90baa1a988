// A leaf in 4x4x4 parts: what a field is worth in each of them, interpolated between the centres of
// the 27 leaves around. With it a leaf on a border counts by the part of it that lies on each side,
// so that volumes do not depend on where a wall happens to fall in the raster.
#pragma once

#include <algorithm>
#include <array>

#include "engine/base/vec.h"

namespace cavum::scenarios {

inline constexpr int k_parts_per_edge = 4, k_parts = 64;
/// Beyond this distance (leaves) from the centre, a surface does not pass through a leaf or the
/// ramp around its parts.
inline constexpr double k_parts_reach_leaves = 1.1;
using LeafParts = std::array<double, k_parts>;

/// `value(leaf)` at the leaves around `leaf`, trilinear at the centres of its parts, x fastest.
template <class Value>
[[nodiscard]] LeafParts leaf_parts(IVec3 leaf, const Value& value) {
  // a part's centre lies -3/8, -1/8, 1/8 or 3/8 of a leaf from the leaf's: shares of the leaf
  // before, the leaf itself, and the next
  constexpr double k_share[k_parts_per_edge][3] = {
      {0.375, 0.625, 0}, {0.125, 0.875, 0}, {0, 0.875, 0.125}, {0, 0.625, 0.375}};
  const auto mix = [](const double* share, double a, double b, double c) {
    return share[0] * a + share[1] * b + share[2] * c;
  };
  double along_x[3][3][k_parts_per_edge], along_xy[3][k_parts_per_edge][k_parts_per_edge];
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y) {
      const double a = value(leaf + IVec3{-1, y - 1, z - 1}),
                   b = value(leaf + IVec3{0, y - 1, z - 1}),
                   c = value(leaf + IVec3{1, y - 1, z - 1});
      for (int i = 0; i < k_parts_per_edge; ++i) along_x[z][y][i] = mix(k_share[i], a, b, c);
    }
  for (int z = 0; z < 3; ++z)
    for (int j = 0; j < k_parts_per_edge; ++j)
      for (int i = 0; i < k_parts_per_edge; ++i)
        along_xy[z][j][i] = mix(k_share[j], along_x[z][0][i], along_x[z][1][i], along_x[z][2][i]);
  LeafParts parts;
  std::size_t at = 0;
  for (int k = 0; k < k_parts_per_edge; ++k)
    for (int j = 0; j < k_parts_per_edge; ++j)
      for (int i = 0; i < k_parts_per_edge; ++i, ++at)
        parts[at] = mix(k_share[k], along_xy[0][j][i], along_xy[1][j][i], along_xy[2][j][i]);
  return parts;
}

/// How much of a part lies where a distance (leaves, at its centre) is positive: exact for a plane
/// across an axis.
[[nodiscard]] inline double share_beyond(double leaves) noexcept {
  return std::clamp(0.5 + k_parts_per_edge * leaves, 0.0, 1.0);
}

}  // namespace cavum::scenarios
