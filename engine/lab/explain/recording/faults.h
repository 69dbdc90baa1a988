// Faults of a recording that would make every answer wrong: found before anything is explained.
#pragma once

#include "engine/base/message.h"
#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

struct DataFault {
  enum class Kind : std::uint8_t { time_stamps, time_base, units, sign, clipped, stuck_force, stuck_position, clock_jump, columns_swapped, too_few };
  Kind kind;
  Message what;  ///< and what to do
};

/// Empty when there is none. Looks at the order of time stamps, at the time base (does the
/// integral of v give x?), at units (metres for millimetres, milliseconds for seconds), at clipped force, and at instruments that did not
/// record (standstill.h).
[[nodiscard]] std::vector<DataFault> data_faults(const Recording& recording);

/// In words.
[[nodiscard]] std::vector<Message> texts_of(const std::vector<DataFault>& faults);

}  // namespace cavum::explain
