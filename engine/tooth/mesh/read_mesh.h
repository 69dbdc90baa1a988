// One closed surface from a mesh file (STL ascii or binary, PLY, OBJ, OFF; read by OpenMesh),
// checked so that it can be filled: finite, closed, 2-manifold, facing outwards.
#pragma once

#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/tooth/surface_mesh.h"

namespace cavum {

struct ReadMesh {
  TriangleMesh mesh;  ///< unused vertices removed, faces outwards (cavities: towards the cavity)
  double volume_mm3 = 0.0;            ///< of the closed surface, cavities subtracted
  Vec3 centroid_mm;                   ///< of that volume
  std::uint64_t unused_vertices = 0;  ///< that were deleted
  bool turned = false;                ///< its faces looked inwards
};

/// Throws Error unless there is a file at `path`.
void require_mesh_file(const std::string& path);

/// Throws Error naming the file when it is missing or unreadable, holds a coordinate that is not
/// finite, encloses nothing, or is open: then with the number of open edges and the place of one.
[[nodiscard]] ReadMesh read_closed_mesh(const std::string& path);

/// Triangles of a surface that may be open and have holes, as a scanner leaves it: at most this
/// many.
inline constexpr std::size_t k_max_scan_triangles = 3'000'000;
/// The surface as it stands in the file, equal corners of an STL joined; unused corners and
/// triangles with a corner twice left out. Nothing is checked of how triangles join. Throws Error
/// naming the file when it is missing or unreadable, holds a coordinate that is not finite, or has
/// more triangles than above.
[[nodiscard]] TriangleMesh read_open_mesh(const std::string& path);

/// A closed surface from the bytes of an STL file, text or binary; `name` stands for the file in
/// errors.
[[nodiscard]] ReadMesh read_closed_stl(const Bytes& file, const std::string& name);

/// The connected parts of a mesh.
[[nodiscard]] std::vector<TriangleMesh> connected_parts(const TriangleMesh& mesh);

}  // namespace cavum
