// A triangle surface as points with a normal and an area: what is averaged over a surface is a sum
// over them, however large its triangles are.
#pragma once

#include <vector>

#include "engine/base/random.h"
#include "engine/base/where.h"
#include "engine/tooth/surface_mesh.h"

namespace cavum {

struct SurfacePoint {
  Vec3 at_mm, normal;  ///< unit, out of the surface
  double area_mm2 = 0.0;
};

/// Places on one surface.
inline constexpr std::size_t k_max_scan_points = 6'000'000;

/// Each triangle in parts with edges of at most `longest_mm`, by halving its longest edge: their
/// middles. Triangles without area give none. Throws Error(`where`, ...) where that would be more
/// than those.
[[nodiscard]] std::vector<SurfacePoint> surface_points(const TriangleMesh& mesh, double longest_mm,
                                                       const Where& where);

/// `count` of them, drawn in proportion to their areas, evenly along the list: the same for the
/// same list.
[[nodiscard]] std::vector<SurfacePoint> drawn_by_area(const std::vector<SurfacePoint>& points,
                                                      std::size_t count, Random& random);

/// Unit normals of a mesh's corners, weighted by the area of their triangles.
[[nodiscard]] std::vector<Vec3> corner_normals(const TriangleMesh& mesh);

[[nodiscard]] double area_of(const std::vector<SurfacePoint>& points) noexcept;

}  // namespace cavum
