// Faults of a recording that would make every answer wrong: found before anything is explained.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "engine/base/message.h"
#include "engine/base/named_enum.h"
#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

// clang-format off
#define CAVUM_DATA_FAULTS(FAULT) \
  FAULT(time_stamps) FAULT(time_base) FAULT(units) FAULT(sign) FAULT(clipped) FAULT(stuck_force) FAULT(stuck_position) FAULT(clock_jump) \
  FAULT(columns_swapped) FAULT(too_few) \
  FAULT(conventions) /* it counts another way than a recording does (conventions.h) */
// clang-format on
CAVUM_NAMED_ENUM(DataFaultKind, CAVUM_DATA_FAULTS)

struct DataFault {
  using Kind = DataFaultKind;
  Kind kind;
  Message what;  ///< and what to do
};

/// Empty when there is none. Looks at the order of time stamps, at the time base (does the
/// integral of v give x?), at units (metres for millimetres, milliseconds for seconds), at clipped
/// force, and at instruments that did not record (standstill.h).
[[nodiscard]] std::vector<DataFault> data_faults(const Recording& recording);

/// For other programs: {"kind", "values", "text"}.
void to_json(nlohmann::json& json, const DataFault& fault);
[[nodiscard]] std::vector<Message> texts_of(const std::vector<DataFault>& faults);

}  // namespace cavum::explain
