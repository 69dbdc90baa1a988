// Volumes by zone and tissue, counted leaf by leaf; a leaf through which a border passes counts by
// its parts.
#pragma once

#include <functional>

#include "grading/measures/grade_input.h"
#include "grading/measures/removed_map.h"

namespace cavum::grading {

/// Rules. A part (leaf_parts.h) of a leaf that held solid tissue is removed where the octree's
/// distance says so; leaves of pulp and the tooth's natural surface count whole, as labelled. A
/// part belongs to the target, leeway or container by its own distance from the target's surface.
/// All zones together are what was removed. Volumes by tissue count whole leaves, for tissues are
/// known leaf by leaf; so does everything when leaves were removed after the end, for the final
/// tooth does not know what it was like before.
[[nodiscard]] VolumeMeasures measure_volumes(const GradeInput& input, const RemovedMap& removed,
                                             std::int64_t last_tick);

/// What of one leaf was removed in one zone.
struct RemovedShare {
  IVec3 leaf;
  std::uint8_t tissue = 0;
  std::int64_t tick =
      0;  ///< of a leaf that is gone in part only: when the last leaf beside it went
  scenarios::Zone zone = scenarios::Zone::none;
  double mm3 = 0.0;
  double bound_mm3 = 0.0;  ///< of it is uncertain: it lies at a border
  double bottom_or_sides_mm3 =
      0.0;  ///< of it lies where bottom and sides meet, and may as well belong to the other
};
/// Something else begins beside a removed leaf: tissue that stayed, or another zone.
[[nodiscard]] bool on_border(const scenarios::ZoneMap& zones, const RemovedMap& removed,
                             IVec3 leaf);
/// Every share that `measure_volumes` counts: those of a zone and their bounds add up to its volume
/// and bound there. Not in order of time.
void for_each_removed_share(const GradeInput& input, const RemovedMap& removed,
                            std::int64_t last_tick,
                            const std::function<void(const RemovedShare&)>& visit);

/// What of a leaf's part in the target was left standing, in leaves, and how much of that is not
/// known, as `measure_volumes` counts it.
struct LeftShare {
  double leaves = 0.0, unsure = 0.0;
};
/// Calls `visit(leaf, left)` for every leaf of which a part belongs to the target and was left
/// standing.
void for_each_left_in_target(const GradeInput& input, const RemovedMap& removed,
                             std::int64_t last_tick,
                             const std::function<void(IVec3, const LeftShare&)>& visit);

}  // namespace cavum::grading
