// The words, tables and pictures of a report, for a student or for an instructor: what
// html_writer.h and pdf_writer.h print.
#pragma once

#include "ui/language/say.h"
#include "ui/report/print/document.h"
#include "ui/report/report_source.h"

namespace cavum::report {

/// The whole report. What belongs to an instructor alone is left out of a student's.
[[nodiscard]] Document report_document(const ReportSource& source);

/// The parts that an instructor sees besides: every figure with its bound, perforation, work,
/// device, proof. Appended to `document`.
void add_instructor_parts(Document& document, const ReportSource& source);

/// Of a scan: volumes and walls, how the scan was laid upon the tooth, and the footer.
void add_scan_parts(Document& document, const ReportSource& source);

/// What the ledger knows that bears on the result: that a regrade gave it, and when and why; that
/// the session was filed with findings, or is contested.
void add_filing_notes(Document& document, const ReportSource& source);
/// All attempts that the reader may see, and whether the marks changed by more than chance.
void add_attempts(Document& document, const ReportSource& source);
/// What a regrade changed, beside the sealed result.
void add_regrade(Document& document, const grading::Comparison& comparison);
/// The verdict of an attempt as a table shows it: one that is in doubt, was regraded, or was sat by
/// a simulated operator, says so.
[[nodiscard]] std::string attempt_verdict(const ReportAttempt& attempt);
/// "this report, not released", and why it is in doubt.
[[nodiscard]] std::string attempt_remark(const ReportAttempt& attempt);

/// What is proved of the session: hashes, closing, replay, ticket, entry. Appended as blocks, and
/// in short as the footer.
void add_integrity(Document& document, const ReportSource& source);

/// "12.3 s" as a cell that jumps there; a dash for a negative tick.
[[nodiscard]] TableCell time_cell(std::int64_t tick, const std::optional<Vec3>& site_mm);
/// "7.5 / 10"; a dash for none.
[[nodiscard]] std::string points_of(const std::optional<double>& points,
                                    const std::optional<double>& max);
/// "1.20, 0.30, -2.10".
[[nodiscard]] std::string location_text(const std::optional<Vec3>& site_mm);
/// Of every figure of a floor's overcut, in the reader's language.
[[nodiscard]] std::string floor_words();
/// How an exam came to its end: "time was up".
[[nodiscard]] Message finish_words(Finish finish);

/// A figure in the reader's language.
[[nodiscard]] inline std::string figure(const Number& n) { return tr("{}", n); }

}  // namespace cavum::report
