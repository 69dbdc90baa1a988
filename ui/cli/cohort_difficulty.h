// `cavum cohort difficulty`: whether the forms of an exam, one task on several teeth, are equally hard.
#pragma once

#include <CLI/CLI.hpp>

namespace cavum::ui {

void add_cohort_difficulty(CLI::App& cohort, int& exit_code);

}  // namespace cavum::ui
