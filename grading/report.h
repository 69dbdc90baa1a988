// The one-page report: one HTML file that needs nothing else, with three sections of removed against target;
// and the three sections alone, as one picture.
#pragma once

#include <string>

#include "grading/grade.h"

namespace cavum {

struct ReportFacts {
  std::string candidate, device, created, session_file, tooth_hash;
};

[[nodiscard]] std::string report_html(const Result& result, const GradeInput& input, const ReportFacts& facts);

/// The report's three sections with the key to their colours: one standalone SVG document.
[[nodiscard]] std::string sections_svg(const Result& result, const GradeInput& input);

}  // namespace cavum
