// Grades an exam: from the tooth before and after, the motion and the scenario's zones to a Result.
// Needs no physics, so an old recording can be graded again for ever; the same input gives the same
// result.
#pragma once

#include "grading/measures/grade_input.h"
#include "grading/result/mark.h"

namespace cavum::grading {

/// `rubric` may be another than the scenario's own.
[[nodiscard]] Result grade(const GradeInput& input, const scenarios::RubricSpec& rubric);

}  // namespace cavum::grading
