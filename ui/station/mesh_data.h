// Meshes of one colour or a few on their way to the graphics card: instruments, targets, zones.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/tooth/surface_mesh.h"
#include "ui/station/gpu.h"

namespace cavum::station {

struct MeshData {
  std::vector<GpuVertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// A closed surface in one colour, its normals the mean of the triangles around each vertex, by
/// their areas.
[[nodiscard]] MeshData smooth_shaded(const TriangleMesh& mesh,
                                     const std::array<std::uint8_t, 4>& colour);

}  // namespace cavum::station
