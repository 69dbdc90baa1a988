// Taking a finished exam into the ledger: is the recording true, was it promised, was it not taken
// in before?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grading/marking/exam_context.h"
#include "grading/marking/school_mark.h"
#include "grading/records/claims.h"
#include "grading/records/ledger.h"
#include "grading/records/registry.h"

namespace cavum::records {

struct Filing {
  Findings findings;  ///< why it was not filed, or with what it was; empty for a sound session
  std::optional<std::uint64_t> seq;  ///< of the new entry; none: refused
};
/// Simulates `session` tick by tick, runs its scenario and marks it again, checks station, source,
/// clocks and ticket, keeps the file in the ledger's folder and enters it with the school's own
/// mark. The file is read once: the bytes that are checked, with a log that lay beside them, are
/// those that are kept and hashed. The entry is written after they are on disk. `grounds` are
/// shared by a class. Throws Error when the file cannot be read as a session, DatabaseError when
/// the disk refuses.
[[nodiscard]] Filing file_session(Ledger& ledger, const std::string& session,
                                  const FilingOptions& options, grading::ExamContexts& grounds);
[[nodiscard]] inline Filing file_session(Ledger& ledger, const std::string& session,
                                         const FilingOptions& options = {}) {
  grading::ExamContexts grounds;
  return file_session(ledger, session, options, grounds);
}

/// The same in two halves: marking, which takes the time and may go on in several threads at once,
/// and what concerns the ledger. Whatever `marked` is filed as was marked here, of the bytes that
/// are kept.
class MarkedRecording {
 public:
  /// Throws Error when the file cannot be read as a session, or was never closed.
  MarkedRecording(const std::string& session, grading::ExamContexts& grounds);

 private:
  friend Filing file_session(Ledger& ledger, const MarkedRecording& marked,
                             const FilingOptions& options);
  Findings findings_;
  Bytes image_;
  SessionReader session_;
  grading::SchoolMark mark_;
};
[[nodiscard]] Filing file_session(Ledger& ledger, const MarkedRecording& marked,
                                  const FilingOptions& options);

}  // namespace cavum::records
