#include "grading/records/ledger.h"

#include <filesystem>

#include "engine/base/memory_reserve.h"
#include "engine/base/text.h"
#include "engine/base/write_file.h"
#include "engine/session/session.h"
#include "grading/records/entry_text.h"
#include "grading/records/erasure.h"
#include "grading/records/ledger_error.h"
#include "grading/records/ledger_file.h"
#include "grading/records/school_keys.h"

namespace cavum::records {

void Ledger::create(const std::string& folder, const std::string& school_name,
                    const SigningKey& key) {
  const LedgerPaths places{folder};
  if (std::filesystem::exists(places.database()))
    throw Error(folder, msg("holds a ledger already"), msg("choose another folder"));
  if (holds_parts_of_a_ledger(places))
    throw Error(LedgerError::lost, Name{folder},
                msg("holds sessions or identities of a ledger whose ledger.db is gone"),
                instead_of_none(places.database()));
  make_private_folder(folder + "/sessions");
  // complete under another name first: a process killed here leaves no half a ledger
  const std::string fresh = temporary_name_next_to(places.database());
  const auto remove_fresh = [&] {
    std::error_code ignored;
    for (const char* end : {"", "-wal", "-shm", "-journal"})
      std::filesystem::remove(fresh + end, ignored);
  };
  try {
    Database db = open_for_adding(fresh, true);
    make_tables(db);
    const std::string id = random_hex(16);
    const LedgerEntry e = make_entry(0, InitEntry{id, to_hex(key.public_key), school_name}, {});
    const Checkpoint p = sign_checkpoint(id, 1, merkle_root(std::span(&e.leaf, 1)), e.utc_ns, key);
    {
      Transaction all(db);
      insert(db, e, {}, checkpoint_note(id, to_hex(key.public_key), p), {});
      all.commit();
    }
    db.run("PRAGMA journal_mode = DELETE");  // one file, to be renamed whole
    db.close();
    tell_witness(id, p);
    if (!put_in_place(fresh, places.database()))
      throw Error(folder, msg("holds a ledger already"), msg("choose another folder"));
  } catch (const std::exception&) {
    remove_fresh();
    throw;
  }
  sync_folder_of(folder);
}

Ledger::Ledger(const std::string& folder, const SigningKey& key, LedgerUse use)
    : places_{folder},
      key_(key),
      use_(use),
      database_(open_for_adding(LedgerPaths{folder}.database(), false)) {
  require_ledger(database_, places_.database());
  reload();
}

void Ledger::keep_cosignatures(std::uint64_t size, std::span<const NoteSignature> cosignatures) {
  Transaction all(database_);
  for (const auto& s : cosignatures) insert_cosignature(database_, size, signature_line(s));
  all.commit();
  reload();
}

void Ledger::reload() {
  registry_ = {};
  try {
    content_ = read_content(database_, places_.database(),
                            use_ == LedgerUse::restore ? AskWitness::no : AskWitness::yes);
  } catch (const DatabaseError&) {
    content_.findings = schema_findings(database_);  // the cause, when tables were altered
    if (content_.findings.empty()) throw;
  }
  if (!content_.findings.empty())
    throw Error(
        LedgerError::damaged, Name{places_.folder},
        use_ != LedgerUse::tell ? msg("nothing is added to a ledger that does not hold ({})",
                                      content_.findings.front().message())
                                : msg("nothing is told of a ledger that does not hold ({})",
                                      content_.findings.front().message()),
        msg("see `cavum ledger verify {}`, and go back to the copy that holds", places_.folder));
  if (content_.public_key != to_hex(key_.public_key))
    throw Error(
        LedgerError::another_key, Name{places_.folder},
        content_.has_key(to_hex(key_.public_key))
            ? msg("has gone on with another key of the school, which took the place of this one")
            : msg("belongs to another school's key"),
        msg("name that key's file with --key, or restore it; `cavum ledger key --replace` that was cut off goes on when it is run again"));
}

nlohmann::json Ledger::receipt(std::uint64_t seq) const { return make_receipt(content_, seq); }

void Ledger::wipe() { wipe_erased(database_, places_.database()); }

void Ledger::refresh() {
  if (static_cast<std::uint64_t>(database_.integer("SELECT count(*) FROM entry")) !=
      content_.entries.size())
    reload();
}

const LedgerEntry& Ledger::append(const MakeEntry& entry, const std::string& reason,
                                  std::span<const Bytes> documents) {
  append_all([&](const LedgerContent& now) { return std::vector<Entry>{entry(now)}; }, reason,
             documents);
  return content_.entries.back();
}

std::size_t Ledger::append_all(const MakeEntries& entries, const std::string& reason,
                               std::span<const Bytes> documents) {
  Actor by = actor_;
  if (!reason.empty()) by.reason = reason;
  return append_signed(
      [&](const LedgerContent& now) {
        require_key_in_time(now, read_clocks().utc_ns);
        return entries(now);
      },
      by, documents, key_);
}

void Ledger::change_key(const SigningKey& next, std::int64_t until_utc_ns,
                        const std::string& reason) {
  append_signed(
      [&](const LedgerContent& now) {
        return std::vector<Entry>{school_key_entry(now, key_, next, until_utc_ns)};
      },
      {"", one_line(reason), ""}, {}, next);
  key_ = next;
  reload();
}

std::size_t Ledger::append_signed(const MakeEntries& entries, const Actor& by,
                                  std::span<const Bytes> documents, const SigningKey& key) {
  Transaction all(database_);
  refresh();
  std::vector<LedgerEntry> added;
  std::vector<Checkpoint> points;
  GrowingRoot tree;
  for (const LedgerEntry& e : content_.entries) tree.add(e.leaf);
  bool erases = false;
  for (Entry& what : entries(content_)) {
    LedgerEntry& e = added.emplace_back(make_entry(tree.size(), std::move(what), by));
    const auto taken = taken_out_by(content_, e);
    tree.add(e.leaf);
    points.push_back(sign_checkpoint(content_.id, tree.size(), tree.root(), e.utc_ns, key));
    insert(database_, e, taken, checkpoint_note(content_.id, to_hex(key.public_key), points.back()),
           added.size() == 1 ? documents : std::span<const Bytes>());
    for (const auto& [part, opening] : openings_of(*e.what))
      opening->text.clear();  // the file has them
    erases = erases || !erased_parts(e).empty();
  }
  if (added.empty()) return 0;
  require_memory(places_.folder);
  make_room_for_witness(content_.id, points.size());
  all.commit();
  const std::size_t number = added.size();
  for (LedgerEntry& e : added) content_.entries.push_back(std::move(e));
  for (const Bytes& d : documents) content_.documents[to_hex(sha256(d))] = d;
  for (const Checkpoint& p : points) {
    content_.checkpoints.push_back(p);
    tell_witness(content_.id, p);
  }
  if (erases) {
    reload();
    wipe();
  }
  return number;
}

}  // namespace cavum::records
