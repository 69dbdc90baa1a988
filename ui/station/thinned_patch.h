// Fewer triangles where nobody works: the vertices of a patch that lie in the same small cell become one, in their middle. What lies on the border of
// two patches is joined with what lies on it alone, and alike from both sides, so thinned patches fit together; towards a patch that stays as it is
// the border stays, too. All patches together remain closed, whichever of them are thinned.
#pragma once

#include "engine/tooth/surface_patches.h"

namespace cavum::station {

/// Where a patch lies, and which patches around it stay as they are.
struct PatchPlace {
  IVec3 number;  ///< of the patch along x, y, z
  double leaf_mm = 0;
  Vec3 origin_mm;           ///< of the tooth
  std::uint32_t whole = 0;  ///< a bit of `beside` for each patch around that stays as it is
  /// Bit of the patch at (dx, dy, dz), each -1, 0 or 1.
  [[nodiscard]] static constexpr std::uint32_t beside(int dx, int dy, int dz) noexcept { return 1u << (dx + 1 + 3 * (dy + 1) + 9 * (dz + 1)); }
};

/// `cell_leaves` along each edge of a cell: 1, 2, 4, 8 or 16; else throws Error.
[[nodiscard]] SurfacePatch thinned(const SurfacePatch& patch, const PatchPlace& place, int cell_leaves);

}  // namespace cavum::station
