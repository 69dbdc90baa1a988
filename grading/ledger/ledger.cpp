#include "grading/ledger/ledger.h"

#include <filesystem>

#include "engine/base/write_file.h"
#include "engine/session/session.h"
#include "grading/ledger/ledger_file.h"

namespace cavum {

using nlohmann::json;

void Ledger::create(const std::string& folder, const std::string& school_name, const SigningKey& key) {
  const LedgerPlaces places{folder};
  if (std::filesystem::exists(places.database())) throw Error(folder, "holds a ledger already", "choose another folder");
  if (holds_parts_of_a_ledger(places))
    throw Error(folder, "holds sessions or identities of a ledger whose ledger.db is gone", instead_of_none(places.database()));
  make_private_folder(folder + "/sessions");
  // complete under another name first: a process killed here leaves no half a ledger
  const std::string fresh = temporary_name_beside(places.database());
  const auto remove_fresh = [&] {
    std::error_code ignored;
    for (const char* end : {"", "-wal", "-shm", "-journal"}) std::filesystem::remove(fresh + end, ignored);
  };
  try {
    Database db = open_for_adding(fresh, true);
    db.run(("PRAGMA application_id = " + std::to_string(k_ledger_application_id)).c_str());
    migrate(db, fresh);
    const std::string id = random_hex(16);
    const LedgerEntry e = make_entry(0, "init", {{"ledger", id}, {"public_key", to_hex(key.public_key)}, {"school", school_name}});
    Checkpoint p{1, merkle_root(std::span(&e.leaf, 1)), e.utc_ns, {}};
    p.signature = key.sign(checkpoint_message(id, p));
    {
      Transaction all(db);
      insert(db, e, p, {});
      all.commit();
    }
    db.run("PRAGMA journal_mode = DELETE");  // one file, to be renamed whole
    db.close();
    tell_witness(id, p);
    if (!put_in_place(fresh, places.database())) throw Error(folder, "holds a ledger already", "choose another folder");
  } catch (const std::exception&) {
    remove_fresh();
    throw;
  }
}

Ledger::Ledger(const std::string& folder, const SigningKey& key, LedgerUse use)
    : places_{folder}, key_(key), use_(use), database_(open_for_adding(LedgerPlaces{folder}.database(), false)) {
  require_ledger(database_, places_.database());
  migrate(database_, places_.database());
  reload();
}

void Ledger::reload() {
  try {
    content_ = read_content(database_, places_.database());
  } catch (const DatabaseError&) {
    content_.findings = schema_findings(database_);  // the cause, when tables were altered
    if (content_.findings.empty()) throw;
  }
  if (!content_.findings.empty())
    throw Error(places_.folder,
                (use_ == LedgerUse::add ? "nothing is added to a ledger that does not hold (" : "nothing is told of a ledger that does not hold (") +
                    content_.findings.front() + ")",
                "see `cavum ledger verify " + places_.folder + "`, and go back to the copy that holds");
  if (content_.public_key != to_hex(key_.public_key))
    throw Error(places_.folder, "belongs to another school's key", "name that key's file with --key, or restore it");
}

void Ledger::refresh() {
  if (static_cast<std::uint64_t>(database_.integer("SELECT count(*) FROM entry")) != content_.entries.size()) reload();
}

const LedgerEntry& Ledger::append(const std::string& kind, const std::function<json(const LedgerContent&)>& body, std::span<const Bytes> documents) {
  Transaction all(database_);
  refresh();
  LedgerEntry e = make_entry(content_.entries.size(), kind, body(content_));
  auto leaves = leaves_of(content_);
  leaves.push_back(e.leaf);
  Checkpoint p{leaves.size(), merkle_root(leaves), e.utc_ns, {}};
  p.signature = key_.sign(checkpoint_message(content_.id, p));
  insert(database_, e, p, documents);
  all.commit();
  content_.entries.push_back(std::move(e));
  content_.checkpoints.push_back(p);
  for (const Bytes& d : documents) content_.documents[to_hex(sha256(d))] = d;
  tell_witness(content_.id, p);
  return content_.entries.back();
}

}  // namespace cavum
