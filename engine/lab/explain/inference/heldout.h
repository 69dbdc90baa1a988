// What the causes gain on sessions that the fit has not seen, with the search for them repeated
// without those sessions. A session's own zero, place, stiffness and lateness are read off itself,
// as far as sessions differ in them at all: they are no one's cause.
#pragma once

#include "engine/lab/explain/inference/explain.h"

namespace cavum::explain {

/// `first` is the view without causes, `null` its surrogates, `spread` what sessions differ by
/// beside the causes. Folds are the view's. rmse over the rows left out, of all folds; interval:
/// percentiles of 500 resamplings of the folds.
[[nodiscard]] Gain heldout_gain(const View& first, const Null& null, const ExplainOptions& options,
                                const SessionSpread& spread, double noise_floor_n);

/// What one cause gains.
struct OwnGain {
  Interval percent;
  std::vector<double> by_fold_percent;
};

/// What each of `causes` gains on sessions that the others and it were fitted without, in percent
/// of the error without it; in their order.
[[nodiscard]] std::vector<OwnGain> gain_of_each(const View& first, const std::vector<Term>& causes,
                                                const SessionSpread& spread);

}  // namespace cavum::explain
