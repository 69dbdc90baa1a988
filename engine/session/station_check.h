// At which stations was an exam begun, taken up again and ended? A copy that was cut back to before
// its end can be closed a second time, and where that was done by another station, or by one that
// does not remember the exam, the file says so.
#pragma once

#include "engine/session/session_reader.h"

namespace cavum {

/// For a person to decide: taken up again or ended by another station than began it; taken up again
/// at a station that does not remember it; taken up again in a recording that does not say who
/// began it. Empty for an exam that one station began, interrupted or not, and ended.
[[nodiscard]] Damages check_stations(const SessionReader& session);

}  // namespace cavum
