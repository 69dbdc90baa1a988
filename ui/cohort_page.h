// A class on one page: how its points lie around the cut, where on the tooth it cuts too much or too little, which criteria are hard and telling, how
// reliable the sum is, whether stations differ, and how far the program agrees with people. Self-contained HTML.
#pragma once

#include <string>

#include "grading/cohort/class_figures.h"
#include "grading/cohort/class_map.h"

namespace cavum {

[[nodiscard]] std::string class_html(const cohort::ClassFigures& figures, const cohort::ClassTooth& tooth);
/// The four pictures of where the class cuts too much or too little, each a complete `<svg>` element: three sections and the view from above.
[[nodiscard]] std::vector<std::string> class_pictures(const cohort::ClassTooth& tooth);

}  // namespace cavum
