// The diamond point as one sees it, turned from its profile, and the head of the handpiece that holds it.
#pragma once

#include "engine/instrument/diamond_point.h"
#include "ui/station/mesh_data.h"

namespace cavum::station {

/// In the tool's frame, mm: tip at the origin, +z towards the handle.
[[nodiscard]] MeshData diamond_point_mesh(const DiamondPoint& point);
/// Its head begins 11 mm above the tip; its neck leans back towards -y.
[[nodiscard]] MeshData handpiece_mesh();

}  // namespace cavum::station
