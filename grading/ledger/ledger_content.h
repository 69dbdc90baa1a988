// What a ledger's file holds, read and checked without changing it: entries, the tree over them, the school's signatures, and the rubrics and
// scenarios that results were marked anew by. What does not hold is said in words.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/base/hash.h"
#include "engine/session/sqlite.h"
#include "grading/ledger/checkpoint.h"

namespace cavum {

/// One entry. `text` is the JSON that is hashed: {"body":…,"kind":…,"seq":…,"utc_ns":…}, keys in order, no spaces.
struct LedgerEntry {
  std::uint64_t seq = 0;
  std::string text;
  Sha256 leaf{};
  std::string attachment;  ///< a result's JSON text, or nothing; its SHA-256 is in the text
  std::string kind;        ///< `init`, `ticket`, `session`, `regrade`, `release`, `forget`, `restore`
  nlohmann::json body;     ///< with `result` out of the attachment in place of `result_sha256`
  std::int64_t utc_ns = 0;
};

/// A text as it is hashed.
[[nodiscard]] inline std::span<const std::uint8_t> ledger_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// What another party has signed of a checkpoint. Outside the tree: anybody may take it out.
struct Cosignature {
  std::uint64_t size = 0;
  NoteSignature by;
};

/// All that a ledger file holds, and what in it does not hold.
struct LedgerContent {
  std::string id;          ///< of the first entry, 32 hexadecimal digits
  std::string public_key;  ///< the school's, hexadecimal
  std::string school;      ///< its name
  bool witnessed = false;  ///< this computer has a witness of the ledger
  std::vector<LedgerEntry> entries;
  std::vector<Checkpoint> checkpoints;     ///< by size; the last one before format 4 in both forms
  std::vector<Cosignature> cosignatures;   ///< by size; whose they are is not checked here
  std::map<std::string, Bytes> documents;  ///< by SHA-256 (hexadecimal): what results were marked anew by
  std::vector<std::string> findings;       ///< in words; empty when entries, tree and signatures hold
  std::vector<std::string> remarks;        ///< what is odd and may be harmless: a clock that was set back
};

/// What lies beside an entry. Of a session's the result that its station sealed, where that is another than the school's mark. Of a regrade's what it
/// was marked by: SHA-256 (hexadecimal) of each document by its name, `rubric.toml`, `scenario.toml`, `attachment/NAME`. Empty when the entry is
/// older than the ledger's documents (format 3).
[[nodiscard]] std::map<std::string, std::string> documents_of(const LedgerEntry& entry);

/// Places of a ledger in its folder.
struct LedgerPlaces {
  std::string folder;
  [[nodiscard]] std::string database() const { return folder + "/ledger.db"; }
  [[nodiscard]] std::string identities() const { return folder + "/identities.db"; }
  [[nodiscard]] std::string session(const std::string& file_sha256) const { return folder + "/sessions/" + file_sha256 + ".cavum"; }
};
/// True where filed sessions or identities are, whose ledger may be gone.
[[nodiscard]] bool holds_parts_of_a_ledger(const LedgerPlaces& places);
/// Is the witness of this computer asked? A copy that was taken while others go on adding is behind it and sound.
enum class AskWitness { yes, no };
/// Reads and checks a ledger file without changing it; with the witness, when this computer has one. Throws Error only when it is no ledger at all.
[[nodiscard]] LedgerContent read_ledger(const LedgerPlaces& places, AskWitness ask = AskWitness::yes);
/// The same of a database that is open. Throws DatabaseError when it cannot be read.
[[nodiscard]] LedgerContent read_content(Database& database, const std::string& where, AskWitness ask = AskWitness::yes);

/// The next entry, as it will be hashed. A `result` in the body goes into the attachment.
[[nodiscard]] LedgerEntry make_entry(std::uint64_t seq, const std::string& kind, nlohmann::json body);
/// The cosignatures of one size.
[[nodiscard]] std::vector<NoteSignature> cosignatures_of(const LedgerContent& content, std::uint64_t size);
/// The tree's leaves, in order.
[[nodiscard]] std::vector<Sha256> leaves_of(const LedgerContent& content);

}  // namespace cavum
