// Bands: each criterion gets a grade in words by limits of its value, as licensing boards give one,
// and too many in a band fail the exam.
#pragma once

#include <string>
#include <vector>

#include "grading/result/result.h"
#include "scenarios/file/scenario.h"

namespace cavum::grading {

/// Puts a marked criterion into its band, and that in words at the end of its reason. A value that
/// cannot be measured, and care for less than half of the work, lie in the worst. Nothing happens
/// to a criterion without limits.
void put_in_band(const Result& result, const scenarios::CriterionSpec& spec,
                 CriterionResult& criterion);

/// Counts the criteria of each band; returns a finding for each band with more than it may have,
/// for the exam is failed by it.
[[nodiscard]] Findings count_bands(Result& result);

}  // namespace cavum::grading
