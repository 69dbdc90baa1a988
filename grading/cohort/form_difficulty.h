// How hard the forms of one exam are beside each other (the same task on different teeth), when the
// same candidates sat all of them: the single group design of Kolen and Brennan, Test Equating,
// Scaling, and Linking. Nothing here changes a mark.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "grading/cohort/statistics.h"

namespace cavum::cohort {

/// Of one form beside the mean of all.
enum class FormVerdict {
  alike,     ///< surely within the limit
  too_easy,  ///< surely easier by more than the limit
  too_hard,  ///< surely harder by more than the limit
  doubtful,  ///< the interval holds an end of the limit: more candidates would tell
};
[[nodiscard]] const char* form_verdict_name(FormVerdict verdict);

/// Marks in percent of the form's points.
struct FormDifficulty {
  double mean = 0.0, mean_error = 0.0;  ///< of its marks, and the standard error over candidates
  /// Mean of its marks less that of all forms, both of the same candidates: above 0 it is easier.
  /// With its standard error, and an interval that holds the truth in all forms at once in 95 of
  /// 100 exams.
  double easier = 0.0, easier_error = 0.0, low = 0.0, high = 0.0;
  double easier_for_weak = 0.0,
         easier_for_able = 0.0;  ///< the same over the less and the more able half
  bool depends_on_skill =
      false;  ///< those two differ by more than chance gives in any form: no constant equates it
  FormVerdict verdict = FormVerdict::doubtful;
  /// Mean equating: what would be added to its marks so that its mean is that of all forms; its
  /// standard error is `easier_error`.
  double constant = 0.0;
};

struct FormsJudged {
  std::vector<FormDifficulty> forms;
  std::size_t candidates = 0;
  double limit = 0.0;   ///< percent of the points: what counts as too easy or too hard
  double spread = 0.0;  ///< standard deviation between forms beyond chance, percent; 0 where chance
                        ///< alone gives as much
  double chance = 1.0;  ///< that of forms of equal difficulty one differs as much from the others,
                        ///< in its standard errors
  double critical = 0.0;  ///< half an interval, in standard errors
};

inline constexpr std::size_t k_fewest_candidates = 10;

/// `marks`: candidates by forms, percent. `skill` orders the candidates by ability, known
/// beforehand. Throws Error with fewer than two forms, fewer than ten candidates, ragged rows or a
/// limit that is not above 0.
[[nodiscard]] FormsJudged judge_forms(const Matrix& marks, std::span<const double> skill,
                                      double limit, std::uint64_t seed);

/// How many candidates would bring the widest interval down to half the limit, about; by the square
/// root law.
[[nodiscard]] std::size_t candidates_needed(const FormsJudged& judged);

}  // namespace cavum::cohort
