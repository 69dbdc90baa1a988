// The school's ledger: one SQLite file to which entries are only ever added. Each entry is a leaf
// of a Merkle tree, and the school signs the tree's root after each (a checkpoint), so that no
// entry can be changed, taken out or slipped in unseen. A witness outside the ledger's folder
// remembers the last checkpoint: a ledger that was put back to an older copy is found by it.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "grading/records/ledger_content.h"
#include "grading/records/ledger_key.h"
#include "grading/records/merkle.h"
#include "grading/records/receipt.h"
#include "grading/records/registry.h"
#include "grading/records/witness.h"

namespace cavum::records {

/// What a ledger is opened for: to add to it, to write of it what the school signs or knows by
/// name, or to let it go on from a backup, which the witness is not asked about.
enum class LedgerUse { add, tell, restore };

class Ledger {
 public:
  /// Makes an entry from what is there so far.
  using MakeEntry = std::function<Entry(const LedgerContent&)>;
  using MakeEntries = std::function<std::vector<Entry>(const LedgerContent&)>;
  /// A new ledger in a folder, made when missing. Throws Error when there is one already.
  static void create(const std::string& folder, const std::string& school_name,
                     const SigningKey& key);
  /// Throws Error, in the words of its use, when anything in it does not hold, or the key is
  /// another school's.
  Ledger(const std::string& folder, const SigningKey& key, LedgerUse use = LedgerUse::add);

  [[nodiscard]] const LedgerContent& content() const noexcept { return content_; }
  /// What its entries add up to.
  [[nodiscard]] const Registry& registry() { return registry_.of(content_); }
  [[nodiscard]] const LedgerPaths& places() const noexcept { return places_; }
  [[nodiscard]] const SigningKey& key() const noexcept { return key_; }
  /// Reads what somebody else has added meanwhile. Throws Error as the constructor does.
  void refresh();
  /// Adds one entry and its checkpoint in one transaction, then tells the witness. It is asked for
  /// while nobody else can add; it may throw, and nothing is added then. Throws DatabaseError when
  /// the disk refuses; the ledger then holds what it held. `reason`: of the actor; else the one
  /// that he gave before. `documents` are kept with it, each once; the entry names them.
  const LedgerEntry& append(const MakeEntry& entry, const std::string& reason = {},
                            std::span<const Bytes> documents = {});
  /// The same with several entries in one transaction: all of them are added, or none. Returns how
  /// many; none may be asked for.
  std::size_t append_all(const MakeEntries& entries, const std::string& reason = {},
                         std::span<const Bytes> documents = {});
  /// Entries that are added from now on name this actor.
  void act_for(Actor actor) { actor_ = std::move(actor); }
  /// Enters that from now on `next` signs, good until `until_utc_ns` (0 = without end), or how long
  /// the present one is good (`next` is that one). The present key signs that, and `next` the entry
  /// and all that follow. Throws Error.
  void change_key(const SigningKey& next, std::int64_t until_utc_ns, const std::string& reason);
  [[nodiscard]] nlohmann::json receipt(std::uint64_t seq) const;
  /// Writes over on disk what entries have taken out. append() does so; this is for a program that
  /// was killed meanwhile. Throws Error.
  void wipe();
  /// Keeps what other parties have signed of the checkpoint of `size` entries. They were checked
  /// before.
  void keep_cosignatures(std::uint64_t size, std::span<const NoteSignature> cosignatures);

 private:
  std::size_t append_signed(const MakeEntries& entries, const Actor& by,
                            std::span<const Bytes> documents, const SigningKey& key);
  void reload();

  LedgerPaths places_;
  SigningKey key_;
  LedgerUse use_;
  Database database_;
  LedgerContent content_;
  GrowingRegistry registry_;
  Actor actor_;
};

}  // namespace cavum::records
