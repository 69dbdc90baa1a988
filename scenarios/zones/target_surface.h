// The surface of a target on a box of leaves: from what the shape says at each leaf's centre to the
// nearest place on its surface. A shape's own value is a true distance only near the surface
// (shape.h); the nearest place makes it one everywhere.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/vec.h"
#include "scenarios/file/facing.h"

namespace cavum::scenarios {

/// Calls `visit(index, cell)` for every cell of a box, x fastest.
template <class Visit>
void for_each_cell(IVec3 size, const Visit& visit) {
  std::size_t i = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, ++i) visit(i, IVec3{x, y, z});
}

/// What a shape says at the centres of a box of leaves, x fastest.
struct ShapeField {
  IVec3 size;
  std::vector<float> level_mm;       ///< negative inside
  std::vector<std::uint8_t> inside;  ///< 1 inside, else 0

  /// From one leaf to the next along y and along z.
  [[nodiscard]] std::size_t row() const noexcept { return static_cast<std::size_t>(size.x); }
  [[nodiscard]] std::size_t layer() const noexcept {
    return row() * static_cast<std::size_t>(size.y);
  }
  [[nodiscard]] std::size_t index(IVec3 c) const noexcept {
    return static_cast<std::size_t>(c.x) + static_cast<std::size_t>(c.y) * row() +
           static_cast<std::size_t>(c.z) * layer();
  }
};

/// The place on the target's surface that is nearest to a leaf's centre.
struct NearestPoint {
  float x = 0, y = 0, z = 0;  ///< leaves, from the centre of the box's first leaf
  Wall wall = Wall::opening;  ///< of the surface's own normal there
  bool found = false;         ///< there is a surface in the box
  [[nodiscard]] Vec3 at() const {
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
  }
};

/// For every leaf of the box. Two places are tried and the nearer one counts: that of the nearest
/// leaf across the surface, and the foot of the perpendicular on the surface's tangent there. Both
/// are put on the surface by the shape's own value, so neither is a leaf's raster. Walls are told
/// as seen from `facing`.
[[nodiscard]] std::vector<NearestPoint> nearest_points(const ShapeField& shape, Facing facing = {});

}  // namespace cavum::scenarios
