// Perforation twice over: as *evidence*, from what a device gives (rendered force, pose, pedal, speed), and
// as *truth*, from the tissue that was removed. The two are found independently and then compared.
#pragma once

#include "grading/measures/grade_input.h"

namespace cavum::grading {

/// Evidence, truth and their comparison. An event is the *aim* when the scenario has aims and its place lies inside target or
/// leeway; else it is a fault. It is confirmed when a leaf of a tissue of that kind was removed from
/// 300 ms before its time to 200 ms after the detector could say so.
[[nodiscard]] PerforationMeasures measure_perforation(const GradeInput& input, std::int64_t ticks);

}  // namespace cavum::grading
