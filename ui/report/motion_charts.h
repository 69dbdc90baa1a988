// Force, depth and handpiece speed over the time of an exam, with its events as numbered lines:
// what a printed report shows where the page has charts that move.
#pragma once

#include <vector>

#include "ui/report/print/document.h"
#include "ui/report/report_source.h"

namespace cavum::report {

/// Three charts of one width under each other. Events bear their number in `source.events`, from 1;
/// those that nearly coincide share a line.
[[nodiscard]] std::vector<Picture> motion_charts(const ReportSource& source);

/// Points of this candidate's attempts in their order, and the pass mark.
[[nodiscard]] Picture attempts_chart(const std::vector<ReportAttempt>& attempts,
                                     double pass_percent);

}  // namespace cavum::report
