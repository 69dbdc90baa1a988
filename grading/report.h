// The one-page report: one HTML file that needs nothing else, with three sections of removed against target;
// and the three sections alone, as one picture.
#pragma once

#include <string>

#include "grading/compare.h"
#include "grading/grade.h"

namespace cavum {

struct ReportFacts {
  std::string candidate, device, created, session_file, tooth_hash;
};

/// `regrade`: what the session was sealed with, where this result is another one; null for the sealed result itself. The report then begins with
/// that it is a regrade, and shows both verdicts and every criterion side by side.
[[nodiscard]] std::string report_html(const Result& result, const GradeInput& input, const ReportFacts& facts, const Comparison* regrade = nullptr);

/// The report's three sections with the key to their colours: one standalone SVG document.
[[nodiscard]] std::string sections_svg(const Result& result, const GradeInput& input);

}  // namespace cavum
