#include "ui/report/report.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "ui/report/integrity.h"
#include "ui/report/print/html_writer.h"
#include "ui/report/print/pdf_writer.h"
#include "ui/report/report_data.h"
#include "ui/report/report_document.h"

namespace cavum::report {

std::string report_html(const ReportSource& source) {
  return html_of(report_document(source), report_data(source));
}
std::string report_pdf(const ReportSource& source) { return pdf_of(report_document(source)); }

void require_report_path(const std::string& path, bool overwrite, bool pictures) {
  if (!path.ends_with(".html") && !path.ends_with(".pdf") && !(pictures && path.ends_with(".svg")))
    throw Error(Name{path}, msg("the kind of report is not clear from its name"),
                pictures
                    ? msg("use a name ending in .html or .pdf, or in .svg for the sections alone")
                    : msg("use a name ending in .html or .pdf"));
  require_writable(path);
  if (!std::filesystem::exists(path) || std::filesystem::file_size(path) == 0 || overwrite) return;
  const std::string text = read_text_file(path, k_largest_file), head = text.substr(0, 200);
  const bool report =
      path.ends_with(".svg")
          ? head.starts_with("<svg") && text.find("id='cavum-sections'") != std::string::npos
      : path.ends_with(".pdf")
          ? head.starts_with("%PDF") && text.find("(Cavum ") != std::string::npos
          : head.starts_with("<!doctype html>") &&
                text.find("id=\"cavum-data\"") != std::string::npos;
  if (!report)
    throw Error(path, msg("exists already and is no report of Cavum"),
                msg("choose another name, or overwrite it with --overwrite"));
}

void write_closing_report(const std::string& path, const std::string& session_path,
                          const grading::Result& result, const grading::GradedSession& graded,
                          ReportReader reader) {
  const grading::GradeInput input = graded.input();
  ReportSource source = report_source(result, input, graded.facts, graded.rubric);
  source.reader = reader;
  source.integrity = read_integrity(session_path);
  write_text_file(path, path.ends_with(".pdf") ? report_pdf(source) : report_html(source));
}

void write_scan_report(const std::string& path, const std::string& scan_path,
                       const grading::GradedScan& graded, const grading::GradeInput& in,
                       const scenarios::RubricSpec& rubric) {
  grading::ReportFacts facts;
  facts.tooth_hash = tooth_hash(in.before);
  ReportSource source{.result = graded.result, .input = in, .facts = facts, .rubric = rubric};
  source.lessons = grading::lessons(in, graded.result);
  source.scan = ReportScan{std::filesystem::path(scan_path).filename().string(),
                           to_hex(sha256(read_file(scan_path))), graded.facts};
  write_text_file(path, path.ends_with(".pdf") ? report_pdf(source) : report_html(source));
}

}  // namespace cavum::report
