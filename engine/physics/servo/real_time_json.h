// How punctual a servo was, for files and screens.
#pragma once

#include <nlohmann/json.hpp>

#include "engine/physics/servo/real_time.h"

namespace cavum {

/// ticks, overruns, made_up, skipped_late, skipped_full, guard_cuts, lateness and work (mean_us, p50_us, p99_us, p999_us, worst_us, histogram),
/// sched_fifo, memory_locked and why they were refused, ended, error.
[[nodiscard]] nlohmann::json to_json(const RealTimeReport& report);

}  // namespace cavum
