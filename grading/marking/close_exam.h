// The end of every exam, whoever gave its input: what was recorded is graded, and the session is
// sealed with tooth and result.
#pragma once

#include <memory>
#include <string>

#include "grading/marking/grade.h"
#include "grading/marking/session_input.h"

namespace cavum::scenarios {
class Exam;
}

namespace cavum::grading {

struct ClosedExam {
  std::unique_ptr<GradedSession> graded;  ///< what the result was made from
  Result result;
};

/// `exam` is over. Throws Error when it cannot be graded or sealed (DatabaseError: the disk
/// refuses; make room or move the recorder, and call again); the session then stays open and can be
/// resumed.
[[nodiscard]] ClosedExam grade_and_close(scenarios::Exam& exam);

}  // namespace cavum::grading
