// How severe stations, raters and tasks are beside one another, when candidates share them only in
// part, and what each candidate's mark would be under conditions of middle severity: a linear model
// of candidates and facets by least squares (two-way and more without interaction: Searle, Linear
// Models; for marks of raters Braun, J. Educational Statistics 13 (1988) 1). It changes no mark:
// adjusted marks stand beside raw ones.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grading/cohort/variance_components.h"

namespace cavum::cohort {

/// One condition of a facet: a station, a rater, a task.
struct Severity {
  std::size_t marks = 0;
  double severity = 0.0;  ///< what it takes off a mark beside the mean of its facet's conditions,
                          ///< in the marks' unit: above 0 it is severe
  double error = 0.0;     ///< standard error: of what candidates, tasks and conditions do together,
                          ///< and of the rest
  bool beyond_chance = false;  ///< it differs by more than the largest of as many equal ones would
                               ///< in 95 of 100 classes (Bonferroni, Student's t)
};
struct SeverityOfFacet {
  std::vector<Severity> conditions;  ///< by level
  /// Facets (0: candidates; 1: tasks) with which it may do something together that these marks
  /// cannot tell from severity, bit i for facet i: then no condition is called beyond chance.
  std::vector<std::uint32_t> indistinguishable_from;
};
struct FairMark {
  double raw = 0.0,
         adjusted =
             0.0;  ///< means of a candidate's marks, without and with what his conditions took off
};
struct SeverityStudy {
  std::vector<SeverityOfFacet> facets;  ///< facet 1, 2, ...
  std::vector<FairMark> persons;        ///< by level of facet 0
  double residual_sd = 0.0;             ///< of a mark, beside candidate and conditions
};
/// `marks`: level 0 is the candidate. A facet with one level is left out (severity 0). Throws Error
/// when conditions share no candidates, directly or over others (nothing compares them), or when
/// nothing is left to judge chance by.
[[nodiscard]] SeverityStudy study_severity(std::span<const StudyMark> marks);

}  // namespace cavum::cohort
