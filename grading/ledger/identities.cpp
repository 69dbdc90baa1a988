#include "grading/ledger/identities.h"

#include <filesystem>

#include "engine/base/text.h"
#include "engine/base/write_file.h"
#include "grading/ledger/candidate_id.h"

namespace cavum {
namespace {

constexpr std::int64_t k_application_id = 0x43617649;  // "CavI"

Identity read(const Statement& s) { return {s.text(0), s.text(1), s.text(2)}; }

std::optional<Identity> first(Statement s) { return s.step() ? std::optional(read(s)) : std::nullopt; }

}  // namespace

Identities::Identities(const std::string& path, bool may_make)
    : database_([&] {
        const bool make = !std::filesystem::exists(path);
        if (make && !may_make)
          throw Error(path, "the identities are not there", "restore them from their backup: without them nobody knows whose marks these are");
        Database db = Database::open(path, make, k_long_wait);
        db.run("PRAGMA synchronous = EXTRA");  // the journal's name is gone from the disk, too: a power cut brings nobody back, and takes nobody away
        if (make) {
          db.run(("PRAGMA application_id = " + std::to_string(k_application_id)).c_str());
          db.run("CREATE TABLE identity (pseudonym TEXT PRIMARY KEY, id TEXT NOT NULL UNIQUE, name TEXT NOT NULL, salt BLOB NOT NULL) STRICT");
          sync_folder_of(path);
        }
        return db;
      }()) {
  if (database_.integer("PRAGMA application_id") != k_application_id) throw Error(path, "holds no identities", "restore it from a backup");
  database_.run("PRAGMA secure_delete = ON");
}

std::string Identities::enrol(const std::string& id, const std::string& name, const SigningKey& school) {
  require_candidate_id("candidate", id);
  require_candidate_id("name", name);
  if (id.empty() || !is_plain_text(id) || !is_plain_text(name))
    throw Error("candidate '" + one_line(id) + "'", "is no name that can be filed", "use letters and digits on one line");
  if (const auto known = of_id(id)) return known->pseudonym;
  const Bytes salt = from_hex(random_hex(16), 16, "salt");
  database_.prepare("INSERT OR IGNORE INTO identity (pseudonym, id, name, salt) VALUES (?, ?, ?, ?)")
      .bind(1, pseudonym_of(school, salt, id))
      .bind(2, id)
      .bind(3, name)
      .bind(4, salt)
      .run();
  const auto now = of_id(id);  // somebody else may have enrolled the same candidate meanwhile
  if (!now) throw Error("candidate '" + one_line(id) + "'", "cannot be enrolled", "try again");
  return now->pseudonym;
}

std::optional<Identity> Identities::of_pseudonym(const std::string& pseudonym) {
  auto s = database_.prepare("SELECT pseudonym, id, name FROM identity WHERE pseudonym = ?");
  s.bind(1, pseudonym);
  return first(std::move(s));
}

std::optional<Identity> Identities::of_id(const std::string& id) {
  auto s = database_.prepare("SELECT pseudonym, id, name FROM identity WHERE id = ?");
  s.bind(1, id);
  return first(std::move(s));
}

std::vector<Identity> Identities::all() {
  std::vector<Identity> out;
  auto s = database_.prepare("SELECT pseudonym, id, name FROM identity ORDER BY pseudonym");
  while (s.step()) out.push_back(read(s));
  return out;
}

std::vector<std::string> Identities::check(const SigningKey& school) {
  std::vector<std::string> findings;
  auto s = database_.prepare("SELECT pseudonym, id, salt FROM identity ORDER BY pseudonym");
  while (s.step())
    if (pseudonym_of(school, s.blob(2), s.text(1)) != s.text(0))
      findings.push_back("identities: " + s.text(0) + " is not whom it was given to; the row was changed");
  return findings;
}

bool Identities::forget(const std::string& pseudonym) {
  if (!of_pseudonym(pseudonym)) return false;
  database_.prepare("DELETE FROM identity WHERE pseudonym = ?").bind(1, pseudonym).run();
  return true;
}

}  // namespace cavum
