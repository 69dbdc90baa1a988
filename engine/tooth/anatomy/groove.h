// The groove that runs through a back tooth's occlusal surface from its mesial to its distal end,
// between the buccal and the lingual side, and where it passes over the two marginal ridges. It is
// there on worn crowns and between low ridges, too, where no hollow holds water.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/tooth/anatomy/height_map.h"

namespace cavum {

/// Where a groove ends at one side of the crown.
struct GrooveEnd {
  std::size_t place = 0;  ///< in the way: the highest place of the ridge; without a ridge where the
                          ///< groove turns down the side
  bool ridge = false;     ///< the groove rises over it
};

struct Groove {
  std::vector<int> way;  ///< cells of the map, from the crown's mesial side to its distal one
  GrooveEnd mesial, distal;
};

/// The larger curvature of the surface itself at each cell of its map, 1/mm, valleys positive: on a
/// steep side that of the heights says little.
[[nodiscard]] std::vector<double> surface_curvature(const HeightMap& map);

/// None where no valley of `least_per_mm` (median curvature across it, 1/mm) runs between two sides
/// that both stand at least 0.1 mm above it; or where an end turns down before the outer part of
/// the crown. Only what stands above `least_z` counts.
[[nodiscard]] std::optional<Groove> find_groove(const HeightMap& map, double least_z,
                                                double least_per_mm);

}  // namespace cavum
