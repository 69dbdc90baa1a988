// The end of every exam, whoever gave its input: what was recorded is graded, and the session is sealed with tooth and result.
#pragma once

#include <memory>
#include <string>

#include "grading/grade.h"
#include "grading/session_input.h"

namespace cavum {

class Exam;

struct ClosedExam {
  std::unique_ptr<GradedSession> graded;  ///< what the result was made from
  Result result;
};

/// `exam` is over, and recorded at `path`. Throws Error when it cannot be read, graded or sealed; the session then stays open and can be resumed.
[[nodiscard]] ClosedExam grade_and_close(Exam& exam, const std::string& path);

}  // namespace cavum
