// What a replay's list holds: what happened in the exam and where points were lost, in the order of
// time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/session_reader.h"

namespace cavum::station {

struct ReplayMoment {
  std::int64_t tick = 0;
  Message what;                     ///< "perforation", a criterion's title
  bool bad = false;                 ///< a fault, or points lost
  std::optional<double> lost = {};  ///< points, more than 0.005
};

/// `result_json`: of a closed session, empty for another. A loss without a moment of its own stands
/// at the end, `ticks`. `with_points` false: the school has not released the marks, and events
/// alone are listed. Throws Error when the result cannot be read.
[[nodiscard]] std::vector<ReplayMoment> replay_moments(const std::vector<TimedEvent>& events,
                                                       const std::string& result_json,
                                                       std::int64_t ticks, bool with_points);
/// The one before (-1) or after (+1) where the replay is; `chosen` tells those of one tick apart.
/// -1 where there is none.
[[nodiscard]] int compared_moment(const std::vector<ReplayMoment>& moments, std::int64_t at,
                                  int chosen, int step);

}  // namespace cavum::station
