// How a surface passes through a cube whose eight corners are inside or outside: the 256 cases of
// marching cubes, worked out from the faces. Inside corners that touch only across a face's
// diagonal are kept apart, seen alike from both cubes at that face, and no triangle has an inner
// side in a face: so the surface of any set of corners is a closed 2-manifold.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cavum {

/// Corner c lies at (c & 1, c >> 1 & 1, c >> 2). An edge runs from its lower corner along an axis.
struct CubeEdge {
  std::uint8_t axis, low_corner;
  [[nodiscard]] constexpr int high_corner() const noexcept { return low_corner | 1 << axis; }
};
/// Triangles of a case, three edges each, counter-clockwise seen from outside.
struct CubeCase {
  static constexpr std::size_t k_max_triangles = 5;
  int triangles = 0;
  std::array<std::uint8_t, 3 * k_max_triangles> edge{};
};

inline constexpr std::array<CubeEdge, 12> k_cube_edges{{{0, 0},
                                                        {0, 2},
                                                        {0, 4},
                                                        {0, 6},
                                                        {1, 0},
                                                        {1, 1},
                                                        {1, 4},
                                                        {1, 5},
                                                        {2, 0},
                                                        {2, 1},
                                                        {2, 2},
                                                        {2, 3}}};
/// By the bits of the corners that are inside. Worked out in the first call.
[[nodiscard]] const std::array<CubeCase, 256>& cube_cases();

}  // namespace cavum
