// A recording of one session, cut into stretches that are treated as sessions: the unit of evidence
// is the session, and one alone shows nothing.
#pragma once

#include <optional>

#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

inline constexpr Eigen::Index k_stretches = 6, k_min_stretch_rows = 300;

/// The recording with its one session cut into k_stretches of about as many rows each, and a note
/// that says so; none when it has several sessions, or fewer than k_stretches × k_min_stretch_rows
/// rows. A cut lies in air where the tool is in air within a quarter of a stretch of it: states
/// that fade (relaxation, play) begin anew there.
[[nodiscard]] std::optional<Recording> in_stretches(const Recording& recording);

}  // namespace cavum::explain
