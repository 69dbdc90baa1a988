// Perforation twice over: as *evidence*, from what a device gives (rendered force, pose, pedal,
// speed), and as *truth*, from the tissue that was laid open. The two are found independently and
// then compared; truth alone decides the verdict.
#pragma once

#include "grading/measures/grade_input.h"
#include "grading/measures/removed_map.h"

namespace cavum::grading {

/// Evidence, truth and their comparison. An event is the *aim* when the scenario has aims and its
/// place lies inside target or leeway; else it is a fault. It is confirmed when a tissue of that
/// kind was opened further from 300 ms before its time to 200 ms after the detector could say so.
/// Truth: exposure.h.
[[nodiscard]] PerforationMeasures measure_perforation(const GradeInput& input,
                                                      const RemovedMap& removed,
                                                      std::int64_t last_tick);

}  // namespace cavum::grading
