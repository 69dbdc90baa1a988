// How much hard tissue the candidate left between the cavity and the pulp, where it is thinnest:
// what decides whether the tooth stays alive. Both surfaces are where the octree's own distance
// puts them between leaves.
#pragma once

#include "grading/measures/grade_input.h"
#include "grading/measures/removed_map.h"

namespace cavum::grading {

/// Smallest straight distance, mm, from the cut surface (hard leaves removed up to `last_tick`
/// beside tissue that was left) to the pulp's wall as it was before the exam; 0 from the tick on in
/// which pulp was removed or laid bare. Under it lies dentin, and enamel where the cavity ends in
/// it. None without pulp, or where nothing hard was cut. Bound: a leaf, half of it for each of the
/// two surfaces.
[[nodiscard]] OverPulpMeasures measure_over_pulp(const GradeInput& input, const RemovedMap& removed,
                                                 std::int64_t last_tick);

}  // namespace cavum::grading
