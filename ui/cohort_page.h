// A class on one page: how its points lie around the cut, which criteria are hard and telling, how reliable the sum is, whether stations differ, and
// how far the program agrees with people. Self-contained HTML.
#pragma once

#include <string>

#include "grading/cohort/class_figures.h"

namespace cavum {

[[nodiscard]] std::string class_html(const cohort::ClassFigures& figures);

}  // namespace cavum
