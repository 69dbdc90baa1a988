// What conditions do together, estimated beside main effects that are no sample: candidate x judge,
// exam x judge and the rest, from the residuals of the linear model of severity.h. They stand in
// the error of a severity: without them a judge would be called severe for what he and an exam did
// together.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "grading/cohort/mark_shares.h"

namespace cavum::cohort {

/// Takes the main effects off: values, one for each mark, to residuals.
using Residuals = std::function<std::vector<double>(std::span<const double>)>;

struct Interaction {
  std::uint32_t effect = 0;          ///< set of facets, bit i for facet i
  std::vector<std::uint32_t> group;  ///< of each mark
  double marks_each = 1;             ///< of a group, on average
  double freedom = 0;                ///< degrees of freedom: groups less main effects
  double variance = 0;  ///< estimated; below 0 counts as 0, and is estimated without it
};
/// Pairs of facets, and last what all do together. Those that part the marks as a larger one does
/// stand in it. `untold`: pairs whose groups leave no freedom beside the main effects (an exam
/// alone, judges with an exam each): nothing tells their variance.
struct Interactions {
  std::vector<Interaction> list;
  std::vector<std::uint32_t> untold;
};
/// `free`: degrees of freedom of all residuals, 1 at least.
[[nodiscard]] Interactions estimate_interactions(std::span<const StudyMark> marks, double free,
                                                 const Residuals& residuals);

/// Error of a sum of the marks by `weights`, and how many degrees of freedom it is known by
/// (Satterthwaite, Biometrics Bulletin 2 (1946) 110).
struct ErrorOfSum {
  double variance = 0, freedom = 0;
};
[[nodiscard]] ErrorOfSum error_of_sum(const Interactions& interactions,
                                      std::span<const double> weights);

}  // namespace cavum::cohort
