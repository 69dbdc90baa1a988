// What a ledger's entries add up to: tickets, sessions, their results and whether these were released.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grading/ledger/ledger_content.h"
#include "grading/ledger/ticket.h"

namespace cavum {

/// A result beside the sealed one.
struct Regrade {
  std::uint64_t seq = 0;  ///< of its entry
  std::int64_t utc_ns = 0;
  std::string reason;
  std::map<std::string, std::string> documents;  ///< what it was marked by (documents_of); empty when that was not kept
  nlohmann::json result;
};

/// What the entries say together.
struct FiledSession {
  std::uint64_t seq = 0;  ///< of its entry
  std::string file_sha256, chain_sha256, candidate, scenario_id, station_key;
  std::string nonce;         ///< of its ticket; empty without one
  nlohmann::json result;     ///< that counts: the sealed one, or the last regrade's
  std::uint64_t result_seq;  ///< of the entry that holds it
  std::vector<std::string> findings;
  std::string simulated;        ///< operator that sat it instead of a candidate; empty for people
  bool released = false;        ///< the result that counts
  nlohmann::json shown;         ///< the last one that was released: it stands until another is; null before
  std::uint64_t shown_seq = 0;  ///< of the entry that holds it
  std::int64_t received_utc_ns = 0;
  std::vector<Regrade> regrades;            ///< the oldest first
  std::vector<std::uint64_t> contested_by;  ///< entries of other endings of the same exam, filed with findings: a person decides which one counts
  /// The regrade that gave the result in `entry`; null for the sealed one.
  [[nodiscard]] const Regrade* regrade(std::uint64_t entry) const {
    for (const auto& r : regrades)
      if (r.seq == entry) return &r;
    return nullptr;
  }
  /// Filed with findings, or contested: it counts for nobody before a person has looked at it.
  [[nodiscard]] bool doubtful() const { return !findings.empty() || !contested_by.empty(); }
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

}  // namespace cavum
