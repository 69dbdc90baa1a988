// A closed mesh as a signed distance on the leaf lattice (OpenVDB). Used for labels, gaps and
// overlaps; the stored surface itself comes from the triangles (distance.h), which are exact.
#pragma once

#include <vector>

#include "engine/tooth/surface_mesh.h"

namespace cavum {

/// Signed distance in leaves at the centres of `lattice`, negative inside, cut off at ±k_fill_band.
/// Parts of the mesh that look inwards are cavities and are subtracted (OpenVDB alone would fill
/// them).
inline constexpr float k_fill_band = 3.0f;
[[nodiscard]] std::vector<float> fill_mesh(const TriangleMesh& mesh_mm, const TissueGrid& lattice);

}  // namespace cavum
