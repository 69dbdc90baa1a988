// A session file as grading wants it: scenario, zones, tooth before and after, motion and events.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grading/marking/exam_context.h"
#include "grading/marking/grade.h"

namespace cavum::grading {

/// What a reader is told of a session beside its figures.
struct ReportFacts {
  std::string candidate;  ///< pseudonym
  MotionSource source;    ///< what moved the stylus
  std::string created, session_file, tooth_hash;
  std::string calibration;             ///< of the device, as text
  std::vector<std::string> burs_toml;  ///< burs in the order of the tray
  std::vector<std::pair<std::string, std::string>> notes =
      {};  ///< of the session: what gave the input, and how
};

struct GradedSession : scenarios::ExamTask {
  scenarios::RubricSpec rubric;               ///< of the session: its own, else the scenario's
  std::shared_ptr<const ExamContext> ground;  ///< may be shared by all who sat the exam
  std::shared_ptr<const Tooth> before;        ///< of `ground`
  Tooth after;
  std::shared_ptr<const scenarios::ZoneMap> zones;
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;
  std::vector<RemovedAt> removed;
  std::vector<TimedEvent> events;
  ReportFacts facts;
  std::string sealed_result_json;     ///< what the exam ended with; empty when it is just ending
  std::int64_t sat_under_ticks = -1;  ///< time limit that the exam ran under
  std::shared_ptr<const ToothApart> apart;  ///< null: nothing stands beside the tooth
  WorkApart own;                            ///< where something does
  std::optional<AdjacentInput> beside;
  [[nodiscard]] GradeInput input() const {
    GradeInput in{
        scenario, apart ? apart->own : *before,  *zones, apart ? own.after : after.octree, inputs,
        records,  apart ? own.removed : removed, events};
    in.sat_under_ticks = sat_under_ticks;
    in.again = &session;
    in.beside = beside ? &*beside : nullptr;
    in.known = ground ? &ground->known : nullptr;
    return in;
  }
};

/// Throws Error when the file is damaged, or was never closed (resume it first).
[[nodiscard]] std::unique_ptr<GradedSession> load_for_grading(const std::string& path);
/// The same with tooth and zones out of `grounds`.
[[nodiscard]] std::unique_ptr<GradedSession> load_for_grading(const std::string& path,
                                                              ExamContexts& grounds);
/// The same of a session that was read already.
[[nodiscard]] std::unique_ptr<GradedSession> load_for_grading(const SessionReader& session,
                                                              ExamContexts& grounds);
/// The same for an exam that is just ending, with the tooth as it is now.
[[nodiscard]] std::unique_ptr<GradedSession> load_for_grading(const SessionReader& session,
                                                              Tooth after, ExamContexts& grounds);

/// Marks the session by a corrected scenario: its zones are laid into the session's tooth, its
/// rubric counts, and what was granted to the candidate stays. The steps stay those that were run.
/// Throws Error when scenario and tooth do not fit, when an STL that the session ran with is
/// another one by now, or when the scenario is that of another task (its id differs) and
/// `another_task` does not allow that.
void use_scenario(GradedSession& session, scenarios::Scenario scenario, bool another_task = false);
/// The same for a rubric; throws ProblemsError naming every criterion that measures what the exam
/// does not have.
void use_rubric(GradedSession& session, scenarios::RubricSpec rubric);

}  // namespace cavum::grading
