// What a session claims beside its recording's truth: that it was promised, by whom it was sat,
// when, and at which station, against what the ledger knows.
#pragma once

#include <string>
#include <vector>

#include "engine/session/session_reader.h"
#include "grading/records/registry.h"

namespace cavum::records {

struct FilingOptions {
  bool without_ticket =
      false;  ///< for exams that nobody promised: practice, or before tickets were used
  bool simulated = false;      ///< also what no candidate's hand moved; it is marked as such
  bool with_findings = false;  ///< files what does not hold, too, with what was found: for an
                               ///< appeal; it is released only by name
};

/// What a closed session's station, source of motion, clocks and ticket claim and the entries so
/// far contradict: what filing asks beside the recording's truth. `received_utc_ns`: the ledger's
/// own time. With `filed`, a second ending of an exam is compared with the one in the ledger's
/// folder.
[[nodiscard]] Findings check_claims(const LedgerContent& content, const Registry& registry,
                                    const SessionReader& session, std::int64_t received_utc_ns,
                                    const FilingOptions& options = {},
                                    const LedgerPaths* filed = nullptr);

/// The same, for one session: what the entries add up to is read for it.
[[nodiscard]] inline Findings check_claims(const LedgerContent& content,
                                           const SessionReader& session,
                                           std::int64_t received_utc_ns,
                                           const FilingOptions& options = {},
                                           const LedgerPaths* filed = nullptr) {
  return check_claims(content, read_registry(content), session, received_utc_ns, options, filed);
}

/// Number of the ticket in a session's notes; empty without one.
[[nodiscard]] std::string ticket_nonce_in(const SessionSetup& setup);
/// What moved the stylus instead of a candidate's hand, in the beginning or after a gap: the
/// operator's name, else the source in words. Empty for a hand.
[[nodiscard]] std::string simulated_by(const SessionReader& session, const SessionSetup& setup);

}  // namespace cavum::records
