// The one-page report: one HTML file that needs nothing else, with three sections of removed against target.
#pragma once

#include <string>

#include "grading/grade.h"

namespace cavum {

struct ReportFacts {
  std::string candidate, device, created, session_file, tooth_hash;
};

[[nodiscard]] std::string report_html(const Result& result, const GradeInput& input, const ReportFacts& facts);

}  // namespace cavum
