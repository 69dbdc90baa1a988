// The report of a class: how its points lie around the cut, where on the tooth it cuts too much or
// leaves too much, which criteria are hard and telling, how reliable the sum is, whether stations
// differ, and how far the program agrees with people. One document, printed as HTML or PDF.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "grading/cohort/class_figures.h"
#include "grading/cohort/class_map.h"
#include "ui/report/print/document.h"

namespace cavum::report {

[[nodiscard]] Document class_document(const cohort::ClassFigures& figures,
                                      const cohort::ClassTooth& tooth);
/// What the page draws: as report_data.h says, with "kind":"class"; `after` is the tooth with
/// exactly the target removed, and "heat" of each cell in the box says how many per cent of the
/// class removed it although it lies outside the target (+), or left it although it lies inside
/// (-).
[[nodiscard]] nlohmann::json class_data(const cohort::ClassFigures& figures,
                                        const cohort::ClassTooth& tooth);

/// One HTML file that needs nothing else, and A4 pages.
[[nodiscard]] std::string class_html(const cohort::ClassFigures& figures,
                                     const cohort::ClassTooth& tooth);
[[nodiscard]] std::string class_pdf(const cohort::ClassFigures& figures,
                                    const cohort::ClassTooth& tooth);

}  // namespace cavum::report
