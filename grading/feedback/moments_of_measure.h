// What `grade --why` lists for each measure of scenarios/file/measures.h. One record each, found by the measure's key.
#pragma once

#include <vector>

#include "grading/feedback/loss_finder.h"
#include "scenarios/file/measures.h"

namespace cavum::grading {

struct MomentsOfMeasure {
  const char* measure = nullptr;  ///< its key
  const char* words = nullptr;    ///< what is listed, for the manual
  void (LossFinder::*list)() = nullptr;
};

/// Throws std::logic_error when a measure has no row, a row no measure, or a row lacks something.
[[nodiscard]] const std::vector<MomentsOfMeasure>& moments_of_measures();
/// `rows`, held against the measures in that way.
[[nodiscard]] std::vector<MomentsOfMeasure> checked_moments(std::vector<MomentsOfMeasure> rows);
[[nodiscard]] const MomentsOfMeasure& moments_of(const scenarios::Measure& measure);

}  // namespace cavum::grading
