// Volumes by zone and tissue, counted leaf by leaf; a leaf through which a border passes counts by its parts.
#pragma once

#include "grading/grade.h"
#include "grading/removed_map.h"

namespace cavum {

/// Rules. A part (leaf_parts.h) of a leaf that held solid tissue is removed where the octree's distance says so; leaves of pulp and the
/// tooth's natural surface count whole, as labelled. A part belongs to the target, leeway or container by its own distance from the
/// target's surface. All zones together are what was removed. Volumes by tissue count whole leaves, for tissues are known leaf by leaf;
/// so does everything when leaves were removed after the end, for the final tooth does not know what it was like before.
[[nodiscard]] VolumeMeasures measure_volumes(const GradeInput& input, const RemovedMap& removed, std::int64_t last_tick);

}  // namespace cavum
