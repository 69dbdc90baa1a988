// The surface that the candidate left: how far each wall lies from where it should be, and the
// cavity's outline, depth and taper. The place of the surface between leaves comes from the
// octree's own distance.
#pragma once

#include "grading/measures/grade_input.h"
#include "grading/measures/removed_map.h"

namespace cavum::grading {

/// Rules: a removed leaf with remaining solid tissue beside it is one sample; its place on the
/// surface is found from the distance that the octree keeps. Its wall is that of the target's
/// nearest surface. The natural wall of a tissue that is not solid (pulp) is no overcut: where such
/// a leaf was removed outside the target it gives no sample. The largest overcut is also that of
/// every removed leaf's centre, and of its face where the next one belongs to another wall and is
/// gone, so that a wall that is gone altogether does not count as kept. Outline and depth are where
/// the distance passes zero between leaves: along lines across the topmost leaves, and down from
/// each removed leaf.
[[nodiscard]] ShapeMeasures measure_shape(const GradeInput& input, const RemovedMap& removed,
                                          std::int64_t last_tick);

}  // namespace cavum::grading
