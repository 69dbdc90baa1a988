// Places that a mesh leaves empty though filling it closes them: a chamber that is cut out of the
// dentin and reaches the outside by a canal thinner than a leaf, which `fill_mesh` fills.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/tooth/surface_mesh.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum {

/// Of the leaves of `lattice`, by crossings along z: 1 where `filled` (of fill_mesh) is negative
/// and an even number of the mesh's triangles lies below. A column whose crossings do not come out
/// even is left out (0).
[[nodiscard]] std::vector<std::uint8_t> hollows(const TriangleMesh& mesh_mm,
                                                const std::vector<float>& filled,
                                                const TissueGrid& lattice);

}  // namespace cavum
