// The accommodations that a verb may grant to a candidate, beside those of the scenario.
#pragma once

#include "scenarios/file/accommodations.h"
#include "ui/parts/option_checks.h"

namespace cavum::ui {

/// `grant` must live as long as the verb.
void add_grant_options(CLI::App* verb, scenarios::Grant& grant);

}  // namespace cavum::ui
