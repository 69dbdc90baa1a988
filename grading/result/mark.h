// Marks by a rubric what was measured: the value of each measure by its name, criteria, points and
// verdict.
#pragma once

#include <optional>
#include <string>

#include "grading/result/result.h"
#include "scenarios/file/scenario.h"

namespace cavum::grading {

/// Value of a measure by its name in scenarios/file/measures.h (`touched_NAME_mm3` for any tissue);
/// none when it cannot be measured. Throws Error when there is no such measure.
struct MetricValue {
  std::optional<double> value;
  double bound = 0.0;
};
[[nodiscard]] MetricValue metric_value(const Result& measured, const std::string& metric);

/// What was not done cannot be done well: the points of a criterion that judges care (everything
/// that an untouched tooth would do best in) count in proportion until this much of the target was
/// removed; for a wall, of the target towards it.
inline constexpr double k_care_counts_percent = 50.0;

/// By how much a grant stretches the exam's limit: the limit with what was granted over the one
/// without; 1 where nothing was.
[[nodiscard]] double granted_stretch(const Result& measured);
/// A criterion as it is marked: one on the exam's time has its limits stretched by
/// `granted_stretch`, so that the same share of the limit gets the same points; any other is as the
/// rubric has it.
[[nodiscard]] scenarios::CriterionSpec as_marked(scenarios::CriterionSpec criterion,
                                                 const Result& measured);

/// Marks an already measured result by a rubric: criteria, points and verdict are replaced.
void mark(Result& result, const scenarios::RubricSpec& rubric);

}  // namespace cavum::grading
