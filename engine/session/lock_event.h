// What was tried to leave a locked exam (LockAttempt), in words for people. Nothing in the motion
// shows it; it is the station's word.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/session/event.h"

namespace cavum {

/// For people: "another window took the keyboard". On one line.
[[nodiscard]] Message lock_words(const LockAttempt& attempt);

/// All of a session, each kind once, in the order in which they came first.
struct LockSummary {
  LockAttempt first;
  std::int64_t first_tick = 0;
  int times = 0;
};
[[nodiscard]] std::vector<LockSummary> lock_summary(std::span<const TimedEvent> events);

}  // namespace cavum
