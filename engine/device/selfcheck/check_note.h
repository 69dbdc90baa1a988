// What a session says of its station's last self-check (note `self_check`), read and held against
// the session.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/where.h"
#include "engine/device/selfcheck/check_entry.h"

namespace cavum {

class SessionReader;

inline constexpr char k_self_check_note[] = "self_check";

struct SessionCheck {
  CheckEntry check;
  std::optional<CheckEntry> decision;
};

/// Both entries signed by the station that they name. Throws Error when it is no such note.
[[nodiscard]] SessionCheck read_session_check(const std::string& note, const Where& where);

struct SessionCheckFindings {
  std::vector<Message> findings;  ///< what does not hold
  std::vector<Message> remarks;   ///< what the check said
};
/// Of a session without that note: nothing.
[[nodiscard]] SessionCheckFindings check_of_session(const SessionReader& session);
/// "Seat 3: unchanged, friction 0.27 N, ... (2026-11-21T08:50:00Z); decided: ...".
[[nodiscard]] Message in_words(const SessionCheck& check);

}  // namespace cavum
