// Taking a finished exam into the ledger: is the recording true, was it promised, was it not taken in before?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grading/ledger/claims.h"
#include "grading/ledger/ledger.h"
#include "grading/ledger/registry.h"

namespace cavum {

struct Filing {
  std::vector<std::string> findings;  ///< why it was not filed, or with what it was; empty for a sound session
  std::optional<std::uint64_t> seq;   ///< of the new entry; none: refused
};
/// Verifies `session` tick by tick, checks its ticket, copies the file into the ledger's folder and enters it. The entry is written after the copy is
/// on disk. Throws Error when the file cannot be read as a session, DatabaseError when the disk refuses.
[[nodiscard]] Filing file_session(Ledger& ledger, const std::string& session, const FilingOptions& options = {});

}  // namespace cavum
