// Warnings of what is legal but unwise in a scenario on its tooth: a target that opens what must
// stay closed, a leeway wider than the wall, a limit shorter than the built-in expert needs, marks
// that nobody can win or lose, burs and steps without use.
#pragma once

#include <optional>
#include <vector>

#include "engine/physics/bur/bur.h"
#include "scenarios/file/parse.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {

/// What the built-in expert can do of a task.
struct ExpertsPart {
  std::optional<double> time_s;  ///< that it needs, about; none where it cannot do the task at all
  double reach =
      0.0;  ///< share of the target that the best allowed bur removes within its margins, 0..1
};

/// Everything to warn of, in no order. `burs` are the allowed ones, in the scenario's order.
[[nodiscard]] std::vector<Problem> advise(const Scenario& scenario, const Tooth& tooth,
                                          const ZoneMap& zones, const std::vector<Bur>& burs,
                                          ExpertsPart& expert);

/// What of it speaks of the rubric, when another one than the scenario's own is to mark an exam.
[[nodiscard]] std::vector<Problem> advise_rubric(Scenario scenario, const RubricSpec& rubric,
                                                 const Tooth& tooth, const ZoneMap& zones);

}  // namespace cavum::scenarios
