// `cavum cohort difficulty`: whether the forms of an exam, one task on several teeth, are equally
// hard.
#pragma once

#include "ui/parts/option_checks.h"

namespace cavum::ui {

void add_cohort_difficulty(CLI::App& cohort, int& exit_code);

}  // namespace cavum::ui
