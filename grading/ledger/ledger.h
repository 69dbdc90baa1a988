// The school's ledger: one SQLite file to which entries are only ever added. Each entry is a leaf of a Merkle tree, and the school signs the tree's
// root after each (a checkpoint), so that no entry can be changed, taken out or slipped in unseen. A witness outside the ledger's folder remembers
// the last checkpoint: a ledger that was put back to an older copy is found by it.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/session/sqlite.h"
#include "grading/ledger/ledger_key.h"
#include "grading/ledger/merkle.h"

namespace cavum {

/// Version of the ledger's tables (SQLite `user_version`).
inline constexpr int k_ledger_format = 2;
/// SQLite `application_id`: "CavL".
inline constexpr std::int64_t k_ledger_application_id = 0x4361764c;

/// One entry. `text` is the JSON that is hashed: {"body":…,"kind":…,"seq":…,"utc_ns":…}, keys in order, no spaces.
struct LedgerEntry {
  std::uint64_t seq = 0;
  std::string text;
  Sha256 leaf{};
  std::string attachment;  ///< a result's JSON text, or nothing; its SHA-256 is in the text
  std::string kind;        ///< `init`, `ticket`, `session`, `regrade`, `release`, `forget`
  nlohmann::json body;     ///< with `result` out of the attachment in place of `result_sha256`
  std::int64_t utc_ns = 0;
};

/// The school's word that the first `size` entries have this root.
struct Checkpoint {
  std::uint64_t size = 0;
  Sha256 root{};
  std::int64_t utc_ns = 0;
  std::array<std::uint8_t, 64> signature{};
};
/// What is signed: "CVCHKPT1", the ledger's id, size, root, utc_ns.
[[nodiscard]] Bytes checkpoint_message(const std::string& ledger_id, const Checkpoint& checkpoint);

/// All that a ledger file holds, and what in it does not hold.
struct LedgerContent {
  std::string id;          ///< of the first entry, 32 hexadecimal digits
  std::string public_key;  ///< the school's, hexadecimal
  std::string school;      ///< its name
  bool witnessed = false;  ///< this computer has a witness of the ledger
  std::vector<LedgerEntry> entries;
  std::vector<Checkpoint> checkpoints;
  std::vector<std::string> findings;  ///< in words; empty when entries, tree and signatures hold
  std::vector<std::string> remarks;   ///< what is odd and may be harmless: a clock that was set back
};

/// Places of a ledger in its folder.
struct LedgerPlaces {
  std::string folder;
  [[nodiscard]] std::string database() const { return folder + "/ledger.db"; }
  [[nodiscard]] std::string identities() const { return folder + "/identities.db"; }
  [[nodiscard]] std::string session(const std::string& file_sha256) const { return folder + "/sessions/" + file_sha256 + ".cavum"; }
};
/// $CAVUM_HOME/witness/ID, or below ~/.config/cavum: one line for each checkpoint, "size root utc_ns".
[[nodiscard]] std::string witness_path(const std::string& ledger_id);

/// Reads and checks a ledger file without changing it; with the witness, when this computer has one. Throws Error only when it is no ledger at all.
[[nodiscard]] LedgerContent read_ledger(const LedgerPlaces& places);

class Ledger {
 public:
  /// A new ledger in a folder, made when missing. Throws Error when there is one already.
  static void create(const std::string& folder, const std::string& school_name, const SigningKey& key);
  /// For adding. Throws Error when anything in it does not hold, or the key is another school's.
  Ledger(const std::string& folder, const SigningKey& key);

  [[nodiscard]] const LedgerContent& content() const noexcept { return content_; }
  [[nodiscard]] const LedgerPlaces& places() const noexcept { return places_; }
  [[nodiscard]] const SigningKey& key() const noexcept { return key_; }
  /// Reads what somebody else has added meanwhile. Throws Error as the constructor does.
  void refresh();
  /// Adds one entry and its checkpoint in one transaction, then tells the witness. `body` is asked for while nobody else can add; it may throw, and
  /// nothing is added then. Throws DatabaseError when the disk refuses; the ledger then holds what it held.
  const LedgerEntry& append(const std::string& kind, const std::function<nlohmann::json(const LedgerContent&)>& body);
  /// {ledger, public_key, entry, leaf, inclusion[], checkpoint}: shows without the ledger that entry `seq` is in it.
  [[nodiscard]] nlohmann::json receipt(std::uint64_t seq) const;

 private:
  void reload();

  LedgerPlaces places_;
  SigningKey key_;
  Database database_;
  LedgerContent content_;
};

/// What a receipt does not show, in words; empty when it holds. `public_key` (hexadecimal): the school's; empty = the receipt's own. With a ledger's
/// content also whether that still begins with what the receipt saw.
[[nodiscard]] std::vector<std::string> check_receipt(const nlohmann::json& receipt, const std::string& public_key, const LedgerContent* ledger);

}  // namespace cavum
