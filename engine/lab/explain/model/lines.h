// Lines in the spectrum of a residual: candidates for chatter and interference. A line is part of
// the noise's own spectrum, so that surrogates have it too: it is judged by its neighbours in
// frequency instead.
#pragma once

#include "engine/lab/explain/model/scene.h"

namespace cavum::explain {

/// Frequencies, Hz, of the strongest lines of `whitened` (weighted residual, white when nothing is
/// left) times the contact, above 1 Hz, strongest first; the spindle's own aliased rates are left
/// out. At most `count`. Those near `known_hz` are left out as well.
[[nodiscard]] std::vector<double> strongest_lines_hz(const Scene& scene, const Series& whitened,
                                                     int count,
                                                     const std::vector<double>& known_hz);
/// Highest frequency that is looked at, as a share of the sampling rate: near half of it nothing
/// can be told.
inline constexpr double k_highest_line = 0.45;

/// Chance that noise of a smooth spectrum shows as much as `whitened` does of a line, by its
/// neighbours in frequency, each session with a phase of its own; times `trials`, 1 at most. `sine`
/// and `cosine`: the line, 0 where it does not act, [rows].
[[nodiscard]] double line_p_value(const Scene& scene, const Series& whitened, const Series& sine,
                                  const Series& cosine, double trials);
/// Frequencies that one session can tell apart.
[[nodiscard]] double line_trials(const Scene& scene);

}  // namespace cavum::explain
