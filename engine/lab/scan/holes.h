// Where a surface ends: its rims, and caps over them.
#pragma once

#include <vector>

#include "engine/tooth/surface_mesh.h"

namespace cavum {

/// One closed rim.
struct Rim {
  std::vector<std::uint32_t> corners;  ///< in order
  double length_mm = 0.0;
  Vec3 middle_mm;
};

/// All rims, the longest first. Where more than two edges of rims meet at one corner it is left to
/// chance how they go on.
[[nodiscard]] std::vector<Rim> rims_of(const TriangleMesh& mesh);

/// Fans from each rim's middle, that close it.
[[nodiscard]] TriangleMesh caps_over(const TriangleMesh& mesh, const std::vector<Rim>& rims);

}  // namespace cavum
