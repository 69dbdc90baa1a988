// What a ledger's file holds, read and checked without changing it: entries, the tree over them,
// the school's signatures, and the rubrics and scenarios that results were marked anew by.
#pragma once

#include <fmt/core.h>

#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/base/hash.h"
#include "engine/session/sqlite.h"
#include "grading/records/checkpoint.h"
#include "grading/records/entry.h"

namespace cavum::records {

/// A text as it is hashed.
[[nodiscard]] inline std::span<const std::uint8_t> ledger_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// What another party has signed of a checkpoint. Outside the tree: anybody may take it out.
struct Cosignature {
  std::uint64_t size = 0;
  NoteSignature by;
};

/// From which size of the tree on a key of the school signs, and until when it is good.
struct SchoolKey {
  std::uint64_t first_size = 1;
  std::string public_key;         ///< hexadecimal
  std::int64_t until_utc_ns = 0;  ///< 0: without end
};

/// All that a ledger file holds, and what in it does not hold.
struct LedgerContent {
  std::string id;               ///< of the first entry, 32 hexadecimal digits
  std::string public_key;       ///< the school's, hexadecimal: the one that signs now
  std::vector<SchoolKey> keys;  ///< all that it has had, the first one first
  std::string school;           ///< its name
  bool witnessed = false;       ///< this computer has a witness of the ledger
  std::vector<LedgerEntry> entries;
  std::vector<Checkpoint> checkpoints;    ///< by size
  std::vector<Cosignature> cosignatures;  ///< by size; whose they are is not checked here
  std::map<std::string, Bytes>
      documents;      ///< by SHA-256 (hexadecimal): what results were marked anew by
  Erased erased;      ///< what entries say was erased
  Findings findings;  ///< empty when entries, tree and signatures hold
  Findings remarks;   ///< what is odd and may be harmless: a clock that was set back
  /// The key that signs a tree of this size; of a larger one than there is, the last.
  [[nodiscard]] const std::string& key_of(std::uint64_t size) const;
  /// True when the school has had it.
  [[nodiscard]] bool has_key(const std::string& public_key) const;
};

/// Places of a ledger in its folder.
struct LedgerPaths {
  std::string folder;
  [[nodiscard]] std::string database() const { return folder + "/ledger.db"; }
  [[nodiscard]] std::string identities() const { return folder + "/identities.db"; }
  [[nodiscard]] std::string session(const std::string& file_sha256) const {
    return fmt::format("{}/sessions/{}.cavum", folder, file_sha256);
  }
};
/// True where filed sessions or identities are, whose ledger may be gone.
[[nodiscard]] bool holds_parts_of_a_ledger(const LedgerPaths& places);
/// Is the witness of this computer asked? A copy that was taken while others go on adding is behind
/// it and sound.
enum class AskWitness { yes, no };
/// Reads and checks a ledger file without changing it; with the witness, when this computer has
/// one. Throws Error only when it is no ledger at all.
[[nodiscard]] LedgerContent read_ledger(const LedgerPaths& places,
                                        AskWitness ask = AskWitness::yes);
/// The same of a database that is open. Throws DatabaseError when it cannot be read.
[[nodiscard]] LedgerContent read_content(Database& database, const std::string& where,
                                         AskWitness ask = AskWitness::yes);

/// The next entry, as it will be hashed. Throws Error where it could not be read back.
[[nodiscard]] LedgerEntry make_entry(std::uint64_t seq, Entry what, Actor by);
/// The cosignatures of one size.
[[nodiscard]] std::vector<NoteSignature> cosignatures_of(const LedgerContent& content,
                                                         std::uint64_t size);
/// The tree's leaves, in order.
[[nodiscard]] std::vector<Sha256> leaves_of(const LedgerContent& content);

}  // namespace cavum::records
