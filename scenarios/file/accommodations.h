// What one candidate is granted beside what the scenario's file says. It is kept with the session
// as notes, so that the scenario stays as its author wrote it, and is taken from there wherever the
// session is resumed, replayed or graded.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/message.h"
#include "engine/base/where.h"
#include "scenarios/file/scenario.h"

namespace cavum::scenarios {

/// Accommodations of one exam: what is set replaces what the file says.
struct Grant {
  std::optional<double> extra_time_percent, extra_time_s;
  std::optional<bool> left_handed, high_contrast;
};

/// Throws Error when a value is outside what a file could say; `where` names the asker.
void require_sound(const Grant& grant, const Where& where);
/// As notes of a session, "accommodation.extra_time_percent" = "25" and so on; numbers in full.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> notes_of(const Grant& grant);
/// What a scenario grants once the notes of a session are heeded. Notes of other kinds are passed
/// over; throws Error on a value that is none.
[[nodiscard]] Accommodations granted(const Accommodations& by_file,
                                     const std::vector<std::pair<std::string, std::string>>& notes,
                                     const Where& where);
/// "25 % and 60 s extra time, left-handed, high-contrast colours"; empty when nothing is granted.
[[nodiscard]] Message accommodations_text(const Accommodations& a);

}  // namespace cavum::scenarios
