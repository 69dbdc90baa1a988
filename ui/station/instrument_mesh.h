// The bur as one sees it, turned from its profile, and the handpiece that holds it: closed bodies
// of metal. The opacity of a corner says how polished it is, 255 = steel.
#pragma once

#include "engine/physics/bur/bur.h"
#include "ui/station/mesh_data.h"

namespace cavum::station {

/// In the tool's frame, mm: tip at the origin, +z towards the handle. The coated head, with bands
/// of grit that wind round it so that one sees it turn, and a little of the neck.
[[nodiscard]] MeshData diamond_head_mesh(const Bur& bur);
/// What is above, up to where the handpiece holds it.
[[nodiscard]] MeshData shank_mesh(const Bur& bur);
/// Its head begins 11 mm above the tip; its neck leans back towards -y.
[[nodiscard]] MeshData handpiece_mesh();

}  // namespace cavum::station
