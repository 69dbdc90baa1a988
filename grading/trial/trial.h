// Tries a scenario's rubric on faulty preparations, without physics: none of them may pass, the
// honest one must; and more of an error must never be better. What `cavum scenario check` says of
// it, and the table of `cavum scenario solve --trial`.
#pragma once

#include <string>
#include <vector>

#include "grading/trial/faulty_preparations.h"
#include "scenarios/file/parse.h"

namespace cavum::grading {

struct TrialRow {
  std::string name;
  Message what;
  Verdict verdict = Verdict::fail;
  double points = 0.0, max = 0.0;
  std::vector<Message> caught_by;  ///< criteria that failed it by a critical limit; else the last
                                   ///< step, left open; else criteria without points
  Message should;  ///< measure that should catch it, and the criterion on it where there is one
};

struct Trial {
  TrialRow honest;                           ///< exactly the target
  std::vector<TrialRow> rows;                ///< the wrong ones
  std::vector<scenarios::Problem> problems;  ///< a mistake for each wrong one that passes, and when
                                             ///< the honest one does not; warnings
  double wall_s = 0.0;                       ///< what it took
};

/// The honest piece of work must pass with so many of the points that need no physics.
inline constexpr double k_honest_percent = 90.0;

/// Screened: first in leaves twice as wide; what is failed there by more than the bounds stands so
/// in the table, with the points of the first look, and what is not is marked anew as the exam
/// would. Full: all of it as the exam would.
enum class Look { screened, full };

/// The same scenario on the same tooth gives the same table, on however many threads it works.
/// Throws Error when the scenario cannot be run.
[[nodiscard]] Trial run_trial(const scenarios::Scenario& scenario, const Tooth& tooth,
                              const scenarios::ZoneMap& zones, Look look);

}  // namespace cavum::grading
