// A recorded session, marked by its own rubric or by another, beside what it was sealed with: what
// `grade` and `report` show.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/base/message.h"
#include "grading/marking/session_input.h"
#include "grading/result/compare.h"

namespace cavum::ui {

/// What a session is marked by; empty: its own.
struct MarkingOptions {
  std::string rubric, scenario;  ///< files (TOML)
  bool another_task = false;     ///< the scenario may be that of another task
  [[nodiscard]] bool anew() const { return !rubric.empty() || !scenario.empty(); }
};

/// The same, read: what is not there is the session's own.
struct Marking {
  std::optional<scenarios::Scenario> scenario;
  std::optional<scenarios::RubricSpec> rubric;
  bool another_task = false;
  std::string rubric_file, scenario_file;  ///< where they come from; or an entry of the ledger
  std::optional<std::uint64_t> entry;
  [[nodiscard]] bool anew() const { return scenario || rubric; }
};

/// A session marked as asked, and beside it what it was sealed with.
struct MarkedSession {
  std::unique_ptr<grading::GradedSession> session;
  scenarios::RubricSpec rubric;
  grading::Result result;
  std::optional<grading::Comparison> comparison;
  bool regrade = false;  ///< the result is not the sealed one, which stands in `comparison`
};
/// Tooth and zones come out of `grounds`.
[[nodiscard]] MarkedSession marked_session(const std::string& path, const MarkingOptions& options,
                                           grading::ExamContexts& grounds);
[[nodiscard]] MarkedSession marked_session(const std::string& path, Marking by,
                                           grading::ExamContexts& grounds);

/// A mistake in what is to be marked by is found before any session is opened; what is unwise is
/// said on standard error.
void require_sound_marking(const MarkingOptions& options);

}  // namespace cavum::ui
