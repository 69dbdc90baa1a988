// The school's own mark of a recorded exam. Whoever files an exam believes neither the sealed
// result nor the recorded events: the motion is simulated again, the scenario is run over it again,
// the work is marked again, and what differs from the recording is said in words. One pass does all
// of it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/verify.h"
#include "grading/marking/exam_context.h"

namespace cavum::grading {

struct SchoolMark {
  VerifyReport replay;    ///< the file, its chain and signature, and the motion
  nlohmann::json result;  ///< this program's mark, as to_json gives it; null when the recording
                          ///< cannot be marked
  Damages exam;  ///< what of scenario, servo, events and sealed result does not hold, or why it
                 ///< cannot be marked
  nlohmann::json sealed_otherwise;  ///< the sealed result where it is not `result`; else null
  [[nodiscard]] bool holds() const { return replay.verified && exam.empty(); }
  /// The replay's, then these.
  [[nodiscard]] Damages findings() const;
};

/// Simulates, runs and marks a closed session again. A sealed result that differs is a finding.
/// What cannot be replayed (another physics version) is not marked. Throws nothing of the
/// recording's own: its damage is in the findings.
[[nodiscard]] SchoolMark mark_again(const SessionReader& session, ExamContexts& grounds);

/// In what two results differ, most important first: verdict, points, each criterion, then further
/// figures by name: "/verdict: pass → fail; …". Empty when they are the same.
[[nodiscard]] std::string result_differences(const nlohmann::json& sealed,
                                             const nlohmann::json& marked);

}  // namespace cavum::grading
