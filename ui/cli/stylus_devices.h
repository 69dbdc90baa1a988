// The stylus side of `cavum devices`: what is there and what is wrong with it, how well one works,
// and where it stands beside the tooth.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "engine/base/error.h"
#include "engine/base/lines.h"

namespace cavum::ui {

/// Empty for none.
[[nodiscard]] nlohmann::json problem_json(const std::optional<Error>& problem);
/// For `cavum devices --json`: a list of {id, name, there, problem, placed, ratings}.
/// `again`: asked twice a second, which not every driver likes; see list_styluses.
[[nodiscard]] nlohmann::json styluses_json(bool again);
/// The same as lines for a terminal.
[[nodiscard]] Lines styluses_text(bool again);
/// Tries the stylus `id` for `seconds` and pushes it gently. Returns 0; 1 when it says nothing or
/// its friction could not be found. Throws Error when it cannot be opened.
int test_stylus(const std::string& id, double seconds, bool friction, bool json);
/// Asks for four marks, and keeps the placement that fits them. Throws Error when they do not fit
/// together.
void place_stylus(const std::string& id);

}  // namespace cavum::ui
