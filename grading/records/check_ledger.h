// The check of a whole ledger: entries, tree, signatures, witness, tickets, and the sessions' files
// beside it.
#pragma once

#include <string>
#include <vector>

#include "grading/pool/makers.h"
#include "grading/records/ledger_content.h"

namespace cavum::records {

struct LedgerCheck {
  Findings findings;     ///< what does not hold
  Findings not_checked;  ///< what could not be checked or was not asked for, and why
  Findings remarks;      ///< what may be harmless
  Findings not_made;     ///< sessions that should have been simulated again, and were not
};
/// What is to be done with the filed recordings: their names below the ledger's folder, sorted,
/// each once, whether or not their files are there and unchanged. Left out are those that were
/// erased, and, where they are to be verified, those that were filed with findings.
[[nodiscard]] pool::Work filed_work(const LedgerPaths& places, pool::What what);

/// What of a ledger holds and what does not: entries, tree, signatures, witness, tickets, and the
/// sessions' files beside it; with `replay` each session is simulated and marked again, and
/// `not_made` are findings.
[[nodiscard]] LedgerCheck check_ledger(const LedgerPaths& places, bool replay);
/// The same with `by`, which makes the lines of filed_work. Those that it could not make are
/// `not_made`.
[[nodiscard]] LedgerCheck check_ledger(const LedgerPaths& places, const pool::Maker& by);

/// Whose ledger is it, and are its identities unchanged? With the school's key at `key_path`, the
/// public key at `public_key_path`, or neither: what is not there is not checked, and `check` says
/// so.
void check_owner(LedgerCheck& check, const LedgerPaths& places, const LedgerContent& content,
                 const std::string& key_path, const std::string& public_key_path);

}  // namespace cavum::records
