// Lines in the spectrum of a residual: candidates for chatter.
#pragma once

#include "engine/explain/model/scene.h"

namespace cavum::explain {

/// Frequencies, Hz, of the strongest lines of `whitened` (weighted residual, white when nothing is left) times the contact,
/// above 1 Hz, strongest first; the spindle's own aliased rates are left out. At most `count`.
[[nodiscard]] std::vector<double> strongest_lines_hz(const Scene& scene, const Series& whitened, int count);

}  // namespace cavum::explain
