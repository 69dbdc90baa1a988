// What a gradebook is told of a released result: it adds up and compares with its own pass mark,
// which is the exam's, so a failure must not read as a pass there, nor a pass as a failure, and all
// of one exam must be on one scale. What was changed for that is said in the feedback.
#pragma once

#include <string>
#include <vector>

#include "engine/base/message.h"
#include "grading/records/exam_scale.h"

namespace cavum::records {

struct ExportedGrade {
  nlohmann::json grade;   ///< the points; 0 where they would pass and the exam was failed; the pass
                          ///< mark where they would fail and it was passed; null of a `review`
  nlohmann::json points;  ///< out of max
  nlohmann::json max;     ///< the exam's own
  bool by_another_rubric =
      false;  ///< one with another maximum: points are scaled, and its criteria are others
  std::string verdict;            ///< "fail (critical: perforation)"
  std::vector<Message> feedback;  ///< sentences
};
/// Of a released result (`shown` is an object).
[[nodiscard]] ExportedGrade exported_grade(const FiledSession& session,
                                           const std::map<std::string, ExamScale>& own_scales);

/// How a gradebook's readers are spoken to: a face's `tr`, or english_text.
using Wording = std::string (*)(const Message&);
/// The feedback on one line.
[[nodiscard]] std::string feedback_text(const ExportedGrade& grade, Wording say);

/// "2026-11-21T09:00:00.250Z": milliseconds, as LTI wants: a platform keeps the score with the
/// later time.
[[nodiscard]] std::string utc_ms_text(std::int64_t utc_ns);

}  // namespace cavum::records
