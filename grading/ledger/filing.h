// Taking a finished exam into the ledger: is the recording true, was it promised, was it not taken in before? And what the entries
// add up to: tickets, sessions, their results and whether these were released.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/session/session_reader.h"
#include "grading/ledger/ledger.h"
#include "grading/ledger/ticket.h"

namespace cavum {

/// What the entries say together.
struct FiledSession {
  std::uint64_t seq = 0;  ///< of its entry
  std::string file_sha256, chain_sha256, candidate, scenario_id, station_key;
  std::string nonce;         ///< of its ticket; empty without one
  nlohmann::json result;     ///< that counts: the sealed one, or the last regrade's
  std::uint64_t result_seq;  ///< of the entry that holds it
  std::vector<std::string> findings;
  std::string simulated;  ///< operator that sat it instead of a candidate; empty for people
  bool released = false;  ///< the result that counts
  nlohmann::json shown;   ///< the last one that was released: it stands until another is; null before
  std::int64_t received_utc_ns = 0;
};
struct IssuedTicket {
  std::uint64_t seq = 0;
  Ticket ticket;
  std::optional<std::uint64_t> used_by;  ///< entry of the session
};
struct Registry {
  std::vector<IssuedTicket> tickets;
  std::vector<FiledSession> sessions;
  /// What entries contradict each other in, in words: a ticket used twice, a session entered twice, a regrade or release of nothing.
  std::vector<std::string> findings;
};
[[nodiscard]] Registry read_registry(const LedgerContent& content);

struct FilingOptions {
  bool without_ticket = false;  ///< for exams that nobody promised: practice, or before tickets were used
  bool simulated = false;       ///< also what a simulated operator sat; it is marked as such
  bool with_findings = false;   ///< files what does not hold, too, with what was found: for an appeal; it is released only by name
};
struct Filing {
  std::vector<std::string> findings;  ///< why it was not filed, or with what it was; empty for a sound session
  std::optional<std::uint64_t> seq;   ///< of the new entry; none: refused
};
/// Verifies `session` tick by tick, checks its ticket, copies the file into the ledger's folder and enters it. The entry is written after the copy is
/// on disk. Throws Error when the file cannot be read as a session, DatabaseError when the disk refuses.
[[nodiscard]] Filing file_session(Ledger& ledger, const std::string& session, const FilingOptions& options = {});

/// What a closed session's ticket, result and events claim and the entries so far contradict, in words: what filing asks beside the recording's
/// truth.
[[nodiscard]] std::vector<std::string> check_claims(const LedgerContent& content, const SessionReader& session, const FilingOptions& options = {});

struct LedgerCheck {
  std::vector<std::string> findings;  ///< what does not hold
  std::vector<std::string> remarks;   ///< what may be harmless
};
/// What in a ledger does not hold: entries, tree, signatures, witness, tickets, and the sessions' files beside it; with `replay` each session is
/// simulated again.
[[nodiscard]] LedgerCheck check_ledger(const LedgerPlaces& places, bool replay);

}  // namespace cavum
