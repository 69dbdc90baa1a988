// What the causes gain on sessions that the fit has not seen, with the search for them repeated without those sessions.
#pragma once

#include "engine/explain/inference/explain.h"

namespace cavum::explain {

/// `first` is the view without causes, `null` its twins, `count` how many causes the whole data had. Folds are the view's.
/// rmse over the rows left out, of all folds; interval: percentiles of 500 resamplings of the folds.
[[nodiscard]] Gain heldout_gain(const View& first, const Scores& scores, const Null& null, std::size_t count, double noise_floor_n);

}  // namespace cavum::explain
