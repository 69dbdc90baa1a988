// A candidate's appeal against a result: an entry when it is made, the marks and decisions that
// follow, and an entry that answers it. While it is open a person may decide the verdict, whatever
// the program said (decision.h).
#pragma once

#include <string>
#include <vector>

#include "grading/records/ledger.h"
#include "grading/records/registry.h"

namespace cavum::records {

/// Whether the result that counts now has another verdict or other points than the one that counted
/// when the appeal was made.
[[nodiscard]] bool changed_since(const FiledSession& session, const Appeal& appeal);

/// Enters an appeal against the result of the session of entry `session`. `reason`: what the
/// candidate objects to, one line without names, kept for ever. Throws Error when the session has
/// no result, or an appeal is open already.
const LedgerEntry& open_appeal(Ledger& ledger, std::uint64_t session, const std::string& reason);
/// Enters the answer to the open appeal of that session. Throws Error when there is none, or the
/// outcome is not what changed_since says.
const LedgerEntry& answer_appeal(Ledger& ledger, std::uint64_t session, Outcome outcome,
                                 const std::string& reason);

}  // namespace cavum::records
