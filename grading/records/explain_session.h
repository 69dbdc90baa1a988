// What is proved of one recorded exam, and what is not, in words for an appeal: whether the file is
// whole and signed, whether the motion gives the forces and the tooth again, whether a ticket
// promised it, and what the clocks say of how it was sat.
#pragma once

#include <string>
#include <vector>

#include "engine/base/lines.h"
#include "grading/records/finding.h"

namespace cavum::grading {
class ExamContexts;
}

namespace cavum::records {

struct SessionExplanation {
  std::string file;
  bool holds = false;        ///< closed, true, and as its ticket promised when it has one
  bool interrupted = false;  ///< does not hold for one reason alone: nobody closed it; what is
                             ///< recorded is intact and can be resumed
  Findings proved;           ///< what holds, each with how it is known
  Findings findings;         ///< what does not hold
  Findings remarks;          ///< what nobody can know from the file, and what the clocks show
};

/// `school_key`: public key (hexadecimal) that must have signed the ticket; empty = whichever did.
/// With one, a session without a ticket does not hold when `ticket_needed`. Throws Error when the
/// file is no session at all.
[[nodiscard]] SessionExplanation explain_session(const std::string& path,
                                                 const std::string& school_key,
                                                 bool ticket_needed = true);
/// The same with tooth and zones out of `grounds`.
[[nodiscard]] SessionExplanation explain_session(const std::string& path,
                                                 const std::string& school_key, bool ticket_needed,
                                                 grading::ExamContexts& grounds);
[[nodiscard]] Lines to_text(const SessionExplanation& explanation);

}  // namespace cavum::records
