// The table of wrong pieces of work, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "engine/base/lines.h"
#include "grading/trial/battery.h"

namespace cavum::grading {

/// A line for each piece of work, the honest one first; what passes is marked by "!".
[[nodiscard]] Lines battery_text(const Battery& battery);
/// `battery` of `scenario solve --json`: the wrong ones.
[[nodiscard]] nlohmann::ordered_json battery_json(const Battery& battery);

}  // namespace cavum::grading
