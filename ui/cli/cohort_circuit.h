// `cavum cohort circuit`: several exams of one class, and how dependable they are together.
#pragma once

#include "ui/parts/option_checks.h"

namespace cavum::ui {

void add_cohort_circuit(CLI::App& cohort, int& exit_code);

}  // namespace cavum::ui
