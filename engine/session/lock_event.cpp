#include "engine/session/lock_event.h"

#include <algorithm>

namespace cavum {

Message lock_words(const LockAttempt& a) {
  switch (a.what) {
    case LockTry::close_asked:
      return msg("the window was asked to close");
    case LockTry::close_refused:
      return msg("a wrong supervisor code was typed");
    case LockTry::close_granted:
      return a.by_supervisor ? msg("the window was closed with the supervisor code")
                             : msg("the window was closed");
    case LockTry::focus_lost:
      return msg("another window took the keyboard");
    case LockTry::focus_back:
      return msg("the keyboard came back");
    case LockTry::screen_lost:
      return msg("a screen was unplugged");
    case LockTry::screen_back:
      return msg("a screen was plugged in");
    case LockTry::second_station:
      return msg("the program was started a second time");
    case LockTry::keyboard_added:
      return msg("a keyboard was plugged in ({})", a.keyboard);
  }
  return {};
}

std::vector<LockSummary> lock_summary(std::span<const TimedEvent> events) {
  std::vector<LockSummary> all;
  for (const TimedEvent& e : events) {
    const auto* a = e.as<LockAttempt>();
    if (a == nullptr) continue;
    const auto known = std::find_if(all.begin(), all.end(),
                                    [&](const LockSummary& s) { return s.first.what == a->what; });
    if (known == all.end())
      all.push_back({*a, e.tick, 1});
    else
      ++known->times;
  }
  return all;
}

}  // namespace cavum
