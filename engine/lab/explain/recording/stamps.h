// Time stamps that were given when a row arrived and not when it was sampled: the motion is smooth
// over the number of the row, and rough over the stamp.
#pragma once

#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

/// The recording with even stamps in each session where that makes the motion at least twice as
/// smooth, with a note; none where it does not.
[[nodiscard]] std::optional<Recording> with_even_stamps(const Recording& recording);

}  // namespace cavum::explain
