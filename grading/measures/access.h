// Straight-line access: what an access task is about beyond volumes. Is the roof off, can an
// instrument go straight into every canal, was the floor kept, do the walls flare as planned?
// Follows the rubric of Education Research International 2021/8829119 (wall flaring; canal access
// without overhangs or dentinal triangles; floor preserved).
//
// "Above" and "below" run along the scenario's approach (ZoneMap::approach). The *aim* is every
// tissue under perforation.aims.
#pragma once

#include "grading/measures/grade_input.h"
#include "grading/measures/removed_map.h"

namespace cavum::grading {

/// Rules. Overhang: hard tissue of the target left standing, by the parts of its leaves, that has a
/// leaf of the aim below it within the target; where the aim begins is a matter of leaves, for the
/// tooth's tissues are. Mouth of a canal: a leaf of the aim just below the target's floor whose
/// next leaf above belongs to the target; it is covered when the straight line from it out of the
/// tooth meets hard tissue that was left. Floor cut: hard leaves removed below the target. Target's
/// taper: mean slope of its side walls where tissue stands beyond them, as `measure_shape` takes
/// that of the cut.
[[nodiscard]] AccessMeasures measure_access(const GradeInput& input, const RemovedMap& removed,
                                            std::int64_t last_tick);

}  // namespace cavum::grading
