// More of an error must never be better: what one kind of error costs as it grows.
#pragma once

#include <vector>

#include "grading/trial/faulty_preparations.h"
#include "scenarios/file/parse.h"

namespace cavum::grading {

/// `grown[i]` is the result of `ladder.amount[i]`, `honest` that without the error. A mistake where
/// more of it passes and less of it fails; a warning where the points rise by more than their
/// bound. Each stands at the criterion that gave most of the rise.
[[nodiscard]] std::vector<scenarios::Problem> judge_growth(const scenarios::Scenario& scenario,
                                                           const Ladder& ladder,
                                                           const Result& honest,
                                                           const std::vector<Result>& grown);

}  // namespace cavum::grading
