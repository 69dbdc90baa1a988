// What was tried to leave a locked exam, as a session records it: one event each, of kind `lock`. Nothing in the motion shows these; they are the
// station's word.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/session/session.h"

namespace cavum {

inline constexpr char k_lock_event[] = "lock";
/// `more` of a close_granted that was a locked station's.
inline constexpr char k_by_supervisor[] = "supervisor";

/// `what` is one of close_asked, close_refused, close_granted, focus_lost, focus_back, screen_lost, screen_back, second_station, keyboard_added.
struct LockAttempt {
  std::string what;
  std::string more;  ///< which keyboard, how many screens, who closed it; may be empty
};

/// Detail of the event: {"what"} or {"more","what"}.
[[nodiscard]] std::string to_json(const LockAttempt& attempt);
/// The same from a recording; `what` is empty when it says none.
[[nodiscard]] LockAttempt lock_attempt_of(const std::string& detail_json);
/// For people: "another window took the keyboard". On one line.
[[nodiscard]] std::string lock_words(const LockAttempt& attempt);

/// All of a session, each kind once, in the order in which they came first.
struct LockSummary {
  std::string words;  ///< of the first
  std::int64_t first_tick = 0;
  int times = 0;
};
[[nodiscard]] std::vector<LockSummary> lock_summary(std::span<const SessionEvent> events);

}  // namespace cavum
