// A study of one set of a circuit's marks, the program's or people's: where differences come from,
// and how dependable the mark of a candidate is, with the exams and judges that it really has.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grading/cohort/variance_components.h"

namespace cavum::cohort {

/// How many exams a circuit needs, at the least and at the most; none: more than k_max_tasks.
struct TasksNeeded {
  std::optional<int> estimate, low, high;
};

struct CircuitStudy {
  StudyDesign design;
  std::vector<std::pair<std::string, std::string>>
      merged;  ///< effects that these marks do not tell from another one, and in which each stands
  VarianceComponents components;
  std::vector<double> error;  ///< standard error of each component
  Marking marking;            ///< how many exams, judges and marks a candidate's mark is of
  double mean = 0.0;          ///< of the candidates' marks
  Dependability as_sat;       ///< of the marks that candidates have, on average over the candidates
  DependabilityRange range;
  std::optional<CutDecision> at_cut;  ///< none where there is no one cut
  std::vector<Dependability>
      by_tasks;            ///< everybody at 1, 2, ... k_max_tasks exams, judges as they were
  TasksNeeded for_enough;  ///< the fewest exams with a phi of k_enough_phi; its range from the
                           ///< bounds of phi
};
/// `cut`: what passes, in the marks' unit, where that is one. Facet 1 is the exam. Throws what
/// VarianceStudy and require_differences throw.
[[nodiscard]] CircuitStudy study_circuit(StudyDesign design, const std::vector<StudyMark>& marks,
                                         std::optional<double> cut);
/// Of marks by candidate, exam and judge. Judges who marked one exam each are nested in it; else
/// they are crossed with exams. Throws Error, too, where each exam has one judge.
[[nodiscard]] CircuitStudy study_of_judges(const std::vector<StudyMark>& marks,
                                           std::optional<double> cut);
inline constexpr double k_enough_phi = 0.80;
inline constexpr int k_max_tasks = 40;

}  // namespace cavum::cohort
