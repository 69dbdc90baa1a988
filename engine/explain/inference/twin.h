// Twins of a recording: the fitted model moves as the tool did, its force gets noise like the residual's, and position and
// force go through the same quanta, clipping and smoothing. Whatever the search finds in twins it finds without a cause.
#pragma once

#include <cstdint>

#include "engine/explain/model/view.h"

namespace cavum::explain {

/// A recording of the same rows. The true path of a twin is the estimated one, shifted by up to half a quantum along the way,
/// so that a hold does not stand at the same place in its cell; where the sessions follow one programme, all stop at the same
/// places (see holds.h). Noise: innovations drawn from the residual's.
[[nodiscard]] Recording make_twin(const View& view, std::uint64_t seed);

}  // namespace cavum::explain
