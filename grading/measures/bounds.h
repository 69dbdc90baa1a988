// How far a figure may be from the true one, when it is made of others that are known within a
// bound. Each function takes the figure at both ends of what it is made of and gives the larger
// way.
#pragma once

#include <vector>

#include "grading/result/result.h"

namespace cavum::grading {

/// Bound of 100 I / (I + M), percent: the share of the target that was removed, I removed and M
/// missed of it. Both ends keep within 0 to 100.
[[nodiscard]] double share_bound_percent(const BoundedVolume& in_target,
                                         const BoundedVolume& missed) noexcept;
/// Bound of Dice = 2 I / (2 I + M + O): I removed of the target, M missed of it, O removed beyond
/// it.
[[nodiscard]] double dice_bound(const BoundedVolume& in_target, const BoundedVolume& missed,
                                const BoundedVolume& beyond) noexcept;

/// A value on a wall, and whether its place may as well belong to another wall, or to this one from
/// another.
struct WallValues {
  std::vector<double> sure;       ///< of this wall
  std::vector<double> own;        ///< of this wall, within a leaf of another
  std::vector<double> of_others;  ///< of another wall, within a leaf of this one
};
/// How far the mean may be off because places near the wall's edge count to one wall or the other;
/// what the leaf adds, `wall_measures` of cut_surface.cpp does. 0 without values.
[[nodiscard]] double mean_bound(const WallValues& values);
/// The same for the 95th percentile (nearest rank).
[[nodiscard]] double p95_bound(const WallValues& values);

/// Part of a side wall: its surface's places, and how far they reach up and down.
struct WallHeight {
  double places = 0.0, low_mm = 1e9, high_mm = -1e9;
};
/// Bound of a mean slope, degrees: a wall of height H whose two ends are known to half a leaf each
/// leans by leaf / H more or less; walls count by their places.
[[nodiscard]] double taper_bound_deg(const std::vector<WallHeight>& walls, double leaf_mm) noexcept;

}  // namespace cavum::grading
