// Faces between leaves, as a raster of a wall.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "scenarios/zones/zone_map.h"

namespace cavum::grading {

inline constexpr double k_stairs =
    0.78539816339744831;  ///< pi/4: length of a curve over that of the stairs along it, on average
                          ///< over directions

/// Edges of the faces that belong to one of them only. A face has the leaves `from` and `to` on its
/// sides.
template <class Face>
[[nodiscard]] std::size_t rim_edges(const std::vector<Face>& faces) {
  std::vector<std::array<int, 3>> edges;  // middles, in half leaves
  for (const Face& f : faces) {
    const IVec3 middle = f.from + f.to + IVec3{1, 1, 1}, axis = f.from - f.to;
    for (const IVec3 step : scenarios::k_six_neighbours)
      if (step.x * axis.x + step.y * axis.y + step.z * axis.z == 0)
        edges.push_back({middle.x + step.x, middle.y + step.y, middle.z + step.z});
  }
  std::sort(edges.begin(), edges.end());
  std::size_t alone = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    alone +=
        (i == 0 || edges[i - 1] != edges[i]) && (i + 1 == edges.size() || edges[i + 1] != edges[i])
            ? 1
            : 0;
  return alone;
}

}  // namespace cavum::grading
