// Which results go to candidates and exports: all that nobody questions, a candidate's, or a single
// entry's. Of several endings of one exam a person chooses one, by its entry; from then on it alone
// counts.
#pragma once

#include "grading/records/ledger.h"
#include "grading/records/registry.h"

namespace cavum::records {

struct ReleaseCommand {
  bool all = false;  ///< what is neither filed with findings, contested, taken back, nor marked
                     ///< otherwise than its class
  bool with_findings = false;  ///< of candidates and sessions also what is
  bool undecided = false;      ///< also results that wait for a person's decision: as `review`
  std::vector<std::string> candidates = {};  ///< pseudonyms
  std::vector<std::uint64_t> sessions = {};  ///< their entries
};
struct Release {
  std::vector<std::uint64_t> results;  ///< of the entries that hold them
  std::size_t withheld = 0;            ///< what was wanted, and goes out by name only
  std::size_t to_decide = 0;           ///< what was wanted, and waits for a person's decision
};
/// What `wish` releases of what is filed. Throws Error when an entry or candidate is not there, a
/// candidate's exam is contested and no ending was chosen yet, two endings of one exam are named,
/// or another ending was chosen before.
[[nodiscard]] Release select_results(const Registry& registry, const ReleaseCommand& wish);
/// Enters their release; nothing when there are none.
Release release_results(Ledger& ledger, const ReleaseCommand& wish);
/// Enters that the released results of these sessions, by their entries, are taken back: they stand
/// in no export until something is released again. `reason`: one line, kept for ever. Throws Error
/// when one is not released, or nothing is named.
const LedgerEntry& retract_results(Ledger& ledger, const std::vector<std::uint64_t>& sessions,
                                   const std::string& reason);

}  // namespace cavum::records
