// The station checks its own stylus, and what it decides on it: opened in its own frame, checked,
// judged by the station's history, added to it.
#pragma once

#include <functional>
#include <string>

#include "engine/device/hardware/stylus_kind.h"
#include "engine/device/selfcheck/arm/arm_check.h"
#include "engine/device/selfcheck/check_history.h"

namespace cavum::ui {

/// Where the arm of this kind is checked: in the middle of its reach, its own frame, mm.
[[nodiscard]] Vec3 checked_at_mm(const StylusKind& kind);

struct SelfCheckOptions {
  std::string new_history;  ///< why what was learnt no longer counts; empty: it does
  std::function<void(const ArmProgress&)> tell = {};
  std::function<bool()> stop = {};
};

struct SelfChecked {
  CheckedStylus stylus;
  Message name;      ///< of the stylus
  CheckEntry entry;  ///< as it was added
};

/// Takes up to a minute; for a thread of its own. Throws Error when the stylus is not ready within
/// 10 s, falls silent, or nothing can be kept.
[[nodiscard]] SelfChecked check_station_stylus(const std::string& id,
                                               const SelfCheckOptions& options);

/// The last check of the station's stylus is missing, found a change on which nobody decided to go
/// on, said nothing, or is older than `hours`.
[[nodiscard]] bool needs_check(const CheckHistory& history, const CheckedStylus& stylus,
                               double hours, std::int64_t now_utc_ns);

/// Kept in the station's history.
void decide_on_check(const CheckedStylus& stylus, bool go_on, const std::string& by,
                     const std::string& reason);

}  // namespace cavum::ui
