// Columns of k and c that come late: delayed, smoothed by a first-order filter, or behind a spring
// in series. Contact begins and ends between two rows, where the column of c jumps: motion is
// straight from row to row, and the jump stands where the motion puts it.
#pragma once

#include "engine/lab/explain/model/mechanism.h"

namespace cavum::explain {

/// What a delay of the whole base force changes in the columns of k and c; `tau_s` below 0: the
/// force comes ahead.
[[nodiscard]] Columns delayed(const Scene& scene, double tau_s);
/// The same for a lag y' = (u − y)/tau.
[[nodiscard]] Columns lagged(const Scene& scene, double tau_s);
/// Response of y'' + 2 damping w y' + w² y = w² u to a series u that is straight from row to row;
/// it begins at rest. `damping` 0 to 1, exclusive.
[[nodiscard]] Series resonance(const Scene& scene, const Series& u, double frequency_hz,
                               double damping);
/// Spring of `mm_per_n` behind the Voigt body, F = k (X − F e) + c (V − F' e): in contact a lag of
/// c e/(1 + k e) and a softer base; F starts from 0 at each contact and never pulls.
[[nodiscard]] Columns in_series(const Scene& scene, double mm_per_n);

}  // namespace cavum::explain
