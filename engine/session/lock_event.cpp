#include "engine/session/lock_event.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"

namespace cavum {

std::string to_json(const LockAttempt& attempt) {
  nlohmann::json j{{"what", attempt.what}};
  if (!attempt.more.empty()) j["more"] = one_line(attempt.more);
  return j.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

LockAttempt lock_attempt_of(const std::string& detail_json) {
  const nlohmann::json j = parse_json_or_null(detail_json);
  return {text_in(j, "what"), text_in(j, "more")};
}

std::string lock_words(const LockAttempt& a) {
  if (a.what == "close_asked") return "the window was asked to close";
  if (a.what == "close_refused") return "a wrong supervisor code was typed";
  if (a.what == "close_granted") return a.more == k_by_supervisor ? "the window was closed with the supervisor code" : "the window was closed";
  if (a.what == "focus_lost") return "another window took the keyboard";
  if (a.what == "focus_back") return "the keyboard came back";
  if (a.what == "screen_lost") return "a screen was unplugged";
  if (a.what == "screen_back") return "a screen was plugged in";
  if (a.what == "second_station") return "the program was started a second time";
  if (a.what == "keyboard_added") return fmt::format("a keyboard was plugged in ({})", one_line(a.more));
  return fmt::format("'{}'", one_line(a.what));
}

std::vector<LockSummary> lock_summary(std::span<const SessionEvent> events) {
  std::vector<LockSummary> all;
  std::vector<std::string> kinds;
  for (const SessionEvent& e : events) {
    if (e.kind != k_lock_event) continue;
    const LockAttempt a = lock_attempt_of(e.detail_json);
    const auto known = std::find(kinds.begin(), kinds.end(), a.what);
    if (known != kinds.end()) {
      ++all[static_cast<std::size_t>(known - kinds.begin())].times;
      continue;
    }
    kinds.push_back(a.what);
    all.push_back({lock_words(a), e.tick, 1});
  }
  return all;
}

}  // namespace cavum
