// The table of faulty preparations, as text and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/base/lines.h"
#include "grading/trial/trial.h"

namespace cavum::grading {

/// A line for each piece of work, the honest one first; what passes is marked by "!".
[[nodiscard]] Lines trial_text(const Trial& trial);
/// `trial` of `scenario solve --json`: the wrong ones.
[[nodiscard]] nlohmann::ordered_json trial_json(const Trial& trial);

}  // namespace cavum::grading
