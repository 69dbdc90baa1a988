// Faults of a recording that would make every answer wrong: found before anything is explained.
#pragma once

#include "engine/base/message.h"
#include "engine/explain/recording/recording.h"

namespace cavum::explain {

/// In words, each with what to do; empty when there is none. Looks at the order of time stamps, at the time base (does the
/// integral of v give x?), at units (metres for millimetres, milliseconds for seconds), at clipped force, and at instruments that did not
/// record (standstill.h).
[[nodiscard]] std::vector<Message> data_faults(const Recording& recording);

}  // namespace cavum::explain
