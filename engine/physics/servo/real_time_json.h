// How punctual a servo was, for files and screens.
#pragma once

#include "engine/base/json_struct.h"
#include "engine/physics/servo/real_time.h"

namespace cavum {

CAVUM_JSON_OF(ServoStop, (error), (fault), (why))
CAVUM_JSON_OF(SystemGrant, (asked), (error))

/// ticks, overruns, made_up, skipped_late, skipped_full, guard_cuts, lateness and work (mean_us,
/// p50_us, p99_us, p999_us, worst_us, histogram), fifo, memory, ended.
[[nodiscard]] nlohmann::json to_json(const RealTimeReport& report);

}  // namespace cavum
