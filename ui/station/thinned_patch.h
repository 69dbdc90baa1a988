// Fewer triangles: the vertices of a patch that lie in the same small cell become one, in their
// middle. What lies on the border of two patches is joined with what lies on it alone, in the
// smaller cells of the two, and alike from both sides: all patches together remain closed, whatever
// their cells.
#pragma once

#include <array>

#include "engine/tooth/surface_patches.h"

namespace cavum::station {

/// Where a patch lies, and the cells of the patches around.
struct PatchPosition {
  IVec3 number;  ///< of the patch along x, y, z
  double leaf_mm = 0;
  Vec3 origin_mm;                  ///< of the tooth
  std::array<int, 27> cells = {};  ///< leaves along the edge of a cell of each patch `beside`,
                                   ///< itself too: 1 (vertices as they are), 2, 4, 8, 16; 0 = none
  /// Of the patch at (dx, dy, dz), each -1, 0 or 1.
  [[nodiscard]] static constexpr std::size_t beside(int dx, int dy, int dz) noexcept {
    return static_cast<std::size_t>(dx + 1 + 3 * (dy + 1) + 9 * (dz + 1));
  }
};

/// Throws Error where cells do not fit a patch, or its own is 0.
[[nodiscard]] SurfacePatch thinned(const SurfacePatch& patch, const PatchPosition& place);

}  // namespace cavum::station
