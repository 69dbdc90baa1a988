// `cavum scenario new`: a commented scenario to start from, by the landmarks of a tooth, or on the
// block.
#pragma once

#include "ui/parts/option_checks.h"

namespace cavum::ui {

/// Adds it to `cavum scenario`. `exit_code` gets what the verb ends with.
void add_scenario_new(CLI::App& scenario, int& exit_code);

}  // namespace cavum::ui
