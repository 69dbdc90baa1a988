#include "grading/marking/close_exam.h"

#include <nlohmann/json.hpp>

#include "grading/result/result_json.h"
#include "scenarios/exam/exam.h"

namespace cavum::grading {

ClosedExam grade_and_close(scenarios::Exam& exam) {
  exam.recorder().flush();
  ClosedExam closed;
  ExamContexts grounds(exam.setup());
  closed.graded = load_for_grading(SessionReader(exam.recorder().image(), exam.recorder().path()),
                                   exam.tooth_now(), grounds);
  closed.result = grade(closed.graded->input(), closed.graded->rubric);
  exam.close(to_json(closed.result).dump());
  return closed;
}

}  // namespace cavum::grading
