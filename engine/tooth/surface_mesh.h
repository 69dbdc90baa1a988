// Closed triangle surfaces out of leaves, by marching tetrahedra on the leaves' centres: each cell
// of eight centres is cut into six tetrahedra, so every crossing is unambiguous and the surface is
// always a closed 2-manifold. Where the border is the solid surface, vertices sit on the stored
// distance (sub-leaf); on inner borders (enamel to dentin), where only labels exist, they sit on
// the labels smoothed over 3 leaves.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/tooth/tooth.h"

namespace cavum {

/// Triangles with shared vertices, mm, counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices_mm;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Six times the signed volume divided by six: mm3, positive when the faces look outwards.
[[nodiscard]] double signed_volume_mm3(const TriangleMesh& mesh);

/// Surface of one tissue by name, or of "solid" (all solid tissues together). Always closed and
/// outward. Throws Error when the tooth has no such tissue or none of it is left.
[[nodiscard]] TriangleMesh surface_mesh(const Tooth& tooth, const std::string& tissue);

/// By tissue id: it is void and lies around the tooth, as periodontium does: 45 % or more of its
/// wall borders air. Of pulp that reaches the sides of a block a third does.
[[nodiscard]] bool lies_around(const Octree& tooth, std::uint8_t tissue);
[[nodiscard]] std::array<bool, 256> tissues_around_tooth(const Tooth& tooth);
/// The outside of the tooth as one looks at it: around all of its tissues but `around`, pulp counts
/// as filled. Closed and outward; what drilling cut off is a part of its own. Throws Error when
/// nothing is left.
[[nodiscard]] TriangleMesh outer_surface(const Tooth& tooth, const std::array<bool, 256>& around);

/// The mesh as a binary STL (32-bit floats), or as a binary little-endian PLY with shared vertices.
[[nodiscard]] Bytes to_stl(const TriangleMesh& mesh);
[[nodiscard]] Bytes to_ply(const TriangleMesh& mesh);
/// Writes by extension, `.stl` or `.ply`. Throws Error on another extension or when the file cannot
/// be written.
void write_mesh_file(const TriangleMesh& mesh, const std::string& path);

}  // namespace cavum
