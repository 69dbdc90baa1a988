#include "engine/session/lock_event.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/text.h"

namespace cavum {

std::string lock_words(const LockAttempt& a) {
  switch (a.what) {
    case LockTry::close_asked:
      return "the window was asked to close";
    case LockTry::close_refused:
      return "a wrong supervisor code was typed";
    case LockTry::close_granted:
      return a.by_supervisor ? "the window was closed with the supervisor code" : "the window was closed";
    case LockTry::focus_lost:
      return "another window took the keyboard";
    case LockTry::focus_back:
      return "the keyboard came back";
    case LockTry::screen_lost:
      return "a screen was unplugged";
    case LockTry::screen_back:
      return "a screen was plugged in";
    case LockTry::second_station:
      return "the program was started a second time";
    case LockTry::keyboard_added:
      return fmt::format("a keyboard was plugged in ({})", one_line(a.keyboard));
  }
  return {};
}

std::vector<LockSummary> lock_summary(std::span<const TimedEvent> events) {
  std::vector<LockSummary> all;
  for (const TimedEvent& e : events) {
    const auto* a = e.as<LockAttempt>();
    if (a == nullptr) continue;
    const auto known = std::find_if(all.begin(), all.end(), [&](const LockSummary& s) { return s.first.what == a->what; });
    if (known == all.end())
      all.push_back({*a, e.tick, 1});
    else
      ++known->times;
  }
  return all;
}

}  // namespace cavum
