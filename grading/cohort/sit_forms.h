// The same simulated students sit every form of an exam: what form_difficulty judges.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "grading/cohort/statistics.h"

namespace cavum::cohort {

struct FormsWanted {
  std::vector<std::string> scenarios;  ///< files, a form each
  int candidates = 40;
  std::uint64_t seed = 1;  ///< of the students' habits
  int at_once = 2;         ///< exams that run side by side
};
struct FormsSat {
  std::vector<std::string> ids;  ///< of the forms
  std::vector<int> level;        ///< of each student, 0 (a beginner) to 100 (an expert)
  std::vector<std::uint64_t> seed;
  Matrix percent;                   ///< students by forms, of the form's points
  std::vector<int> passed;          ///< of each form: how many students
  double pass_percent = 0.0;        ///< the same of all forms
  double borderline_percent = 0.0;  ///< the least of all forms
};
/// Student i of n is `student-LEVEL` with levels spread evenly over 0 to 100, and has habits of his
/// own that he brings to every form. `done(i)` after each exam. Throws Error when a form cannot be
/// sat, when two forms are one exam, or when their pass marks differ.
[[nodiscard]] FormsSat sit_forms(const FormsWanted& wanted, const std::function<void(int)>& done);

}  // namespace cavum::cohort
