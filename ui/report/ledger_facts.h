// What the school's ledger knows of a session that a report is made of: its entry, whether it was
// released, the candidate's other attempts.
#pragma once

#include <string>

#include "grading/records/regrade.h"
#include "ui/report/report_source.h"

namespace cavum::report {

/// A ledger that holds, as reports read it. Throws Error when there is none or something in it does
/// not hold.
struct ReportLedger {
  explicit ReportLedger(const std::string& folder);
  records::LedgerPaths places;
  records::LedgerContent content;
  records::Registry registry;
  /// The session with this file; throws Error when it was never filed. `path` names it in the
  /// error.
  [[nodiscard]] const records::FiledSession& session(const std::string& file_sha256,
                                                     const std::string& path) const;
};

/// `with_name`: also who the candidate is, from the ledger's identities. Throws Error when the
/// reader may not see that: a student's report of a result that was not released, or a name before
/// that.
[[nodiscard]] ReportFiling filing_of(const ReportLedger& ledger,
                                     const records::FiledSession& session, ReportReader reader,
                                     bool with_name);

/// The regrade whose result a reader's report is of: the last one for an instructor, the released
/// one for a student; null for the sealed result.
[[nodiscard]] const records::Regrade* regrade_for(const records::FiledSession& session,
                                                  ReportReader reader);

/// Throws Error when a student's report of `result` would not be the released result: it was marked
/// by something else, or by another version of the program.
void require_released_result(const records::FiledSession& session, const grading::Result& result);
/// What a report says when `result` is not the one that the ledger holds for its reader; empty when
/// it is.
[[nodiscard]] Message not_the_filed_result(const records::FiledSession& session,
                                           const grading::Result& result, ReportReader reader);

}  // namespace cavum::report
