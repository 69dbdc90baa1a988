// The built-in expert takes a scenario's exam: the proof that it can be passed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/fact.h"
#include "grading/result/result.h"
#include "scenarios/exam/exam.h"
#include "scenarios/operators/simulated_exam.h"

namespace cavum::ui {

/// A simulated candidate takes the exam; the session is sealed with the result.
[[nodiscard]] grading::Result sat_by(const scenarios::ExamSetup& setup,
                                     scenarios::SimulatedCandidate& candidate,
                                     const std::string& session);

/// What `solve` found out; `result` is missing when the expert could not even begin.
struct Solved {
  std::optional<grading::Result> result;
  std::string bur;
  Facts reasons;  ///< why it was not passed
  Fact advice;    ///< what to change then
};

/// `session` is the file to write; `seed` of the expert's tremor.
[[nodiscard]] Solved solve_exam(const scenarios::ExamSetup& setup, std::uint64_t seed,
                                const std::string& session);

}  // namespace cavum::ui
