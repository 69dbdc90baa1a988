#include "ui/report/report.h"

#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "ui/report/html_writer.h"
#include "ui/report/integrity.h"
#include "ui/report/pdf_writer.h"
#include "ui/report/report_data.h"
#include "ui/report/report_document.h"

namespace cavum {

std::string report_html(const ReportSource& source) { return html_of(report_document(source), report_data(source)); }
std::string report_pdf(const ReportSource& source) { return pdf_of(report_document(source)); }

void write_closing_report(const std::string& path, const std::string& session_path, const Result& result, const GradedSession& graded) {
  const GradeInput input = graded.input();
  ReportSource source = report_source(result, input, graded.facts, graded.rubric);
  source.integrity = read_integrity(session_path, false);
  write_text_file(path, path.ends_with(".pdf") ? report_pdf(source) : report_html(source));
}

}  // namespace cavum
