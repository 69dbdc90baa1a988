// The occlusal table: what drains into the groove and the hollows between the cusps, and not down
// the outside. Its edge runs over the cusp ridges and the marginal ridges; the lines that water
// would take inside it are the fissures.
#pragma once

#include <optional>
#include <vector>

#include "engine/tooth/anatomy/height_map.h"

namespace cavum {

struct OcclusalTable {
  std::vector<std::uint8_t> inside;  ///< per cell of the map
  std::vector<int> edge;  ///< cells of the inside along its outer border, counter-clockwise seen
                          ///< from above, closed
};

/// Watershed between the lowest places of the table, which are given, and the outside (Meyer's
/// flooding, J. Vis. Commun. Image R. 1 (1990) 21); the largest piece, holes filled. None when no
/// place is given, or the piece is smaller than 2 mm2.
[[nodiscard]] std::optional<OcclusalTable> occlusal_table(const HeightMap& map,
                                                          const std::vector<int>& lowest);

/// The way inside `allowed` from the nearest of some cells to the nearest of others along which
/// valleys are cheap: each step costs its length over (k_floor + curvature). Empty where there is
/// no way.
[[nodiscard]] std::vector<int> valley_path(const HeightMap& map,
                                           const std::vector<std::uint8_t>& allowed,
                                           const std::vector<double>& curvature,
                                           const std::vector<int>& from,
                                           const std::vector<int>& to);

}  // namespace cavum
