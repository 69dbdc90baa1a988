// Grades an exam: from the tooth before and after, the motion and the scenario's zones to a Result. Needs
// no physics, so an old recording can be graded again for ever; the same input gives the same result.
#pragma once

#include <span>
#include <vector>

#include "engine/session/session.h"
#include "engine/session/session_reader.h"
#include "grading/result.h"
#include "scenarios/scenario.h"

namespace cavum {

/// Raised whenever the same recording may get another verdict, other points or another criterion than before. It stands in every result.
inline constexpr int k_grading_version = 1;

/// Everything a grade depends on. `inputs` and `records` are of one length; `removed` is in order of ticks.
struct GradeInput {
  const Scenario& scenario;
  const Tooth& before;
  const ZoneMap& zones;
  const Octree& after;
  std::span<const TickInput> inputs;
  std::span<const TickRecord> records;
  std::span<const RemovedAt> removed;
  std::span<const SessionEvent> events;  ///< kinds as event_name gives them; others are ignored
  std::int64_t sat_under_ticks = -1;     ///< time limit that the exam ran under when `scenario` came later; -1 = that of `scenario`
};

/// Ticks of `recorded` that count: up to and with the one in which the exam was over.
[[nodiscard]] std::int64_t counted_ticks(std::int64_t recorded, std::span<const SessionEvent> events);

/// `rubric` may be another than the scenario's own.
[[nodiscard]] Result grade(const GradeInput& input, const RubricSpec& rubric);

/// Value of a measure by its name in scenarios/names.h (`touched_NAME_mm3` for any tissue); none when it cannot be
/// measured. Throws Error when there is no such measure.
struct MetricValue {
  std::optional<double> value;
  double bound = 0.0;
};
[[nodiscard]] MetricValue metric_value(const Result& measured, const std::string& metric);

/// What was not done cannot be done well: the points of a criterion that judges care (everything that an untouched tooth would
/// do best in) count in proportion until this much of the target was removed; for a wall, of the target towards it.
inline constexpr double k_care_counts_percent = 50.0;

/// Marks an already measured result by a rubric: criteria, points and verdict are replaced.
void mark(Result& result, const RubricSpec& rubric);

}  // namespace cavum
