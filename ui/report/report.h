// The report of a recorded exam, for a student or an instructor, as one HTML file or as PDF: the
// same words, figures and pictures.
#pragma once

#include <string>

#include "ui/report/report_source.h"

namespace cavum::report {

/// One file that needs nothing else, with the tooth in 3D and the motion where a browser has
/// scripts and WebGL.
[[nodiscard]] std::string report_html(const ReportSource& source);
/// A4 pages. The same source gives the same bytes.
[[nodiscard]] std::string report_pdf(const ReportSource& source);

/// Throws Error when no report can be put at `path`: its name ends in .html or .pdf, with
/// `pictures` in .svg, too; an earlier report may be written anew, any other file only with
/// `overwrite`.
void require_report_path(const std::string& path, bool overwrite = false, bool pictures = false);

/// The report of an exam that has just been closed, without a replay, as `path` ends: .pdf or else
/// HTML.
void write_closing_report(const std::string& path, const std::string& session_path,
                          const grading::Result& result, const grading::GradedSession& graded,
                          ReportReader reader);

/// The report of a scan that was marked, as `path` ends: .pdf or else HTML. `in` is what was
/// marked.
void write_scan_report(const std::string& path, const std::string& scan_path,
                       const grading::GradedScan& graded, const grading::GradeInput& in,
                       const scenarios::RubricSpec& rubric);

}  // namespace cavum::report
