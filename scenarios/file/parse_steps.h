// Reads the steps of a scenario, with their conditions; and ids, which steps and criteria have
// alike.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenarios/file/checked_toml.h"
#include "scenarios/file/scenario.h"

namespace cavum::scenarios {

/// Where the values of a file stand, by their path in it.
using Places = std::map<std::string, Place>;

/// Small letters, digits, _ and -, one at least.
[[nodiscard]] bool good_id(const std::string& id);
/// `id` of a table; what is none becomes a problem of it.
[[nodiscard]] std::string read_id(CheckedTable& t, const std::string& fallback);

/// All [[steps]]; mistakes go to `problems`.
[[nodiscard]] std::vector<StepSpec> read_steps(CheckedTable& scenario, Places& places,
                                               ProblemList& problems);
/// The button of pauses cannot also be asked for in a condition.
void check_pause_button(const Scenario& scenario, ProblemList& problems);

}  // namespace cavum::scenarios
