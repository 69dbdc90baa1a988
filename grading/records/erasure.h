// Erasing what a ledger holds about people: recordings of their hands, with the accommodations in
// them, and results. An entry says what is gone; all hashes, the tree and every proof stay as they
// are.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "grading/records/identities.h"
#include "grading/records/ledger.h"
#include "grading/records/registry.h"

namespace cavum::records {

/// What entries say was erased; adds findings for what they name and cannot be erased.
[[nodiscard]] Erased read_erased(const std::vector<LedgerEntry>& entries, Findings& findings);
/// The entry that says that `what` of entry `seq` was erased.
[[nodiscard]] std::optional<std::uint64_t> erased_by(const Erased& erased, std::uint64_t seq,
                                                     Part what);
/// What an entry says was erased.
[[nodiscard]] const std::vector<ErasedPart>& erased_parts(const LedgerEntry& entry);
/// The openings, by their hashes, that an entry takes out of the ledger's file.
[[nodiscard]] std::vector<std::string> taken_out_by(const LedgerContent& content,
                                                    const LedgerEntry& entry);

struct ErasureCommand {
  std::vector<std::uint64_t> sessions = {};  ///< their entries
  std::optional<std::int64_t> received_before =
      {};                ///< and those that came in before this time, UTC in ns
  bool motion = false;   ///< the recording: motion, forces, ticket and accommodations
  bool results = false;  ///< the school's mark, all regrades, and what the station sealed
};
/// Enters the erasure, then takes it out of the file and removes recordings. Returns what was
/// erased; nothing is entered when that is nothing. Throws Error when an entry is no session's, or
/// `reason` is none.
std::vector<ErasedPart> erase(Ledger& ledger, const ErasureCommand& wish,
                              const std::string& reason);
/// Enters that these pseudonyms' identities are removed, one entry for each, and erases of their
/// sessions what `wish` says; its own list of sessions is not asked. What incidents say of them is
/// erased.
void forget(Ledger& ledger, const std::vector<std::string>& pseudonyms, const ErasureCommand& wish);
/// Removes identities that an entry says are forgotten, after a crash, or in a file of before.
/// Returns how many.
std::size_t remove_forgotten(const LedgerContent& content, Identities& identities);
/// The ledger's identities, without those that were forgotten. Throws Error when one of them was
/// changed by hand.
[[nodiscard]] Identities sound_identities(const Ledger& ledger);
/// SHA-256 of recordings that an entry says are erased.
[[nodiscard]] std::set<std::string> erased_recordings(const LedgerContent& content);
/// Removes those that are still there, after a crash, or in a backup of before. Returns how many.
/// Throws Error when one cannot be removed.
std::size_t remove_erased_recordings(const LedgerContent& content, const LedgerPaths& places);

}  // namespace cavum::records
