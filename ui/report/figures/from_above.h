// The tooth from above as the candidate left it: what was cut is coloured by how far its surface
// lies from the target's walls and floor.
#pragma once

#include "grading/marking/grade.h"
#include "ui/report/print/document.h"

namespace cavum::report {

/// A picture with its key. Blue: so much of the target was left; orange: so much was cut beyond it;
/// white: as planned. What stands beside the tooth has colours of its own, and one for what was cut
/// of it.
[[nodiscard]] Picture picture_from_above(const grading::GradeInput& input);
/// The same, had the target been taken out and nothing else; without key.
[[nodiscard]] Picture picture_as_planned(const grading::GradeInput& input);

}  // namespace cavum::report
