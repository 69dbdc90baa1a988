#include "grading/records/identities.h"

#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/base/text.h"
#include "engine/base/write_file.h"
#include "grading/records/candidate_id.h"

namespace cavum::records {
namespace {

constexpr std::int64_t k_application_id = 0x43617649;  // "CavI"

constexpr std::int64_t k_format = 1;
constexpr char k_table[] =
    "CREATE TABLE identity (pseudonym TEXT PRIMARY KEY, exam TEXT NOT NULL, id TEXT NOT NULL, name TEXT NOT NULL, seal BLOB NOT NULL, "
    "UNIQUE (id, exam)) STRICT";

struct Row {
  Identity who;
  Bytes seal;
};

Statement select(Database& db, const std::string& which) {
  return db.prepare(("SELECT pseudonym, exam, id, name, seal FROM identity " + which).c_str());
}

std::vector<Row> rows(Statement s) {
  std::vector<Row> out;
  while (s.step()) out.push_back({{s.text(0), s.text(1), s.text(2), s.text(3)}, s.blob(4)});
  return out;
}

std::vector<Identity> identities(Statement s) {
  std::vector<Identity> out;
  for (auto& r : rows(std::move(s))) out.push_back(std::move(r.who));
  return out;
}

/// What is sealed of a row.
std::string sealed_text(const Identity& i) {
  return nlohmann::json{i.pseudonym, i.exam, i.id, i.name}.dump();
}

bool holds(const Row& r, const SigningKey& school) {
  return r.seal == identity_seal(school, sealed_text(r.who));
}

}  // namespace

Identities::Identities(const std::string& path, bool may_make)
    : database_([&] {
        std::error_code none;
        const bool there = std::filesystem::exists(path),
                   make = !there || (may_make && std::filesystem::file_size(path, none) == 0);
        if (make && !may_make)
          throw Error(
              path, msg("the identities are not there"),
              msg("restore them from their backup: without them nobody knows whose marks these are"));
        Database db = Database::open(path, !there, k_long_wait);
        db.run(
            "PRAGMA synchronous = EXTRA");  // the journal's name is gone from the disk, too: a
                                            // power cut brings nobody back, and takes nobody away
        if (make) {
          Transaction all(db);  // whole or empty, and who finds it empty makes it again
          db.run(fmt::format("PRAGMA application_id = {}", k_application_id).c_str());
          db.run(k_table);
          db.run(fmt::format("PRAGMA user_version = {}", k_format).c_str());
          all.commit();
          sync_folder_of(path);
        }
        return db;
      }()) {
  if (database_.integer("PRAGMA application_id") != k_application_id)
    throw Error(path, msg("holds no identities"), msg("restore it from a backup"));
  if (const auto format = database_.integer("PRAGMA user_version"); format != k_format)
    throw Error(path,
                msg("is of format {}, and this version of Cavum reads format {}", format, k_format),
                msg("use the version that wrote it"));
  database_.run("PRAGMA secure_delete = ON");
  if (database_.integer(
          "SELECT count(*) FROM sqlite_schema WHERE name NOT LIKE 'sqlite\\_%' ESCAPE '\\'") != 1 ||
      database_.text("SELECT sql FROM sqlite_schema WHERE name = 'identity'") != k_table)
    throw Error(
        path,
        msg("holds tables or triggers that this program did not make: who is forgotten might stay in them"),
        msg("restore it from a backup, and find out who changed it"));
}

std::string Identities::enrol(const std::string& id, const std::string& name,
                              const std::string& exam, const SigningKey& school) {
  require_candidate_id(msg("candidate"), id);
  require_candidate_id(msg("name"), name);
  if (is_pseudonym(id))
    throw Error(msg("candidate '{}'", id),
                msg("is what a pseudonym looks like, and would be taken for one"),
                msg("give the school's own number or address"));
  if (id.empty() || !is_plain_text(id) || !is_plain_text(name))
    throw Error(msg("candidate '{}'", one_line(id)), msg("is no name that can be filed"),
                msg("use letters and digits on one line"));
  for (const auto& known : of_id(id))
    if (known.exam == exam) return known.pseudonym;
  const Identity i{new_pseudonym(), exam, id, name};
  database_
      .prepare(
          "INSERT OR IGNORE INTO identity (pseudonym, exam, id, name, seal) VALUES (?, ?, ?, ?, ?)")
      .bind(1, i.pseudonym)
      .bind(2, i.exam)
      .bind(3, i.id)
      .bind(4, i.name)
      .bind(5, identity_seal(school, sealed_text(i)))
      .run();
  for (const auto& known :
       of_id(id))  // somebody else may have enrolled the same candidate meanwhile
    if (known.exam == exam) return known.pseudonym;
  throw Error(msg("candidate '{}'", one_line(id)), msg("cannot be enrolled"), msg("try again"));
}

std::optional<Identity> Identities::of_pseudonym(const std::string& pseudonym) {
  auto s = select(database_, "WHERE pseudonym = ?");
  s.bind(1, pseudonym);
  const auto found = identities(std::move(s));
  return found.empty() ? std::nullopt : std::optional(found[0]);
}

std::vector<Identity> Identities::of_id(const std::string& id) {
  auto s = select(database_, "WHERE id = ? ORDER BY exam");
  s.bind(1, id);
  return identities(std::move(s));
}

std::vector<Identity> Identities::of_person(const std::string& who) {
  const auto by_pseudonym = of_pseudonym(who);
  return of_id(by_pseudonym ? by_pseudonym->id : who);
}

std::vector<Identity> Identities::all() {
  return identities(select(database_, "ORDER BY pseudonym"));
}

Findings Identities::check(const SigningKey& school) {
  Findings findings;
  for (const auto& r : rows(select(database_, "ORDER BY pseudonym")))
    if (!holds(r, school))
      findings.push_back(finding<FindingKind::identities_changed>(r.who.pseudonym));
  return findings;
}

void Identities::seal_again(const SigningKey& before, const SigningKey& now) {
  Transaction all(database_);
  for (const auto& r : rows(select(database_, "ORDER BY pseudonym"))) {
    if (!holds(r, before) && !holds(r, now))
      throw Error(msg("identities"),
                  msg("{} is not whom it was given to; the row was changed", r.who.pseudonym),
                  msg("restore the file from its backup"));
    database_.prepare("UPDATE identity SET seal = ? WHERE pseudonym = ?")
        .bind(1, identity_seal(now, sealed_text(r.who)))
        .bind(2, r.who.pseudonym)
        .run();
  }
  all.commit();
}

bool Identities::forget(const std::string& pseudonym) {
  if (!of_pseudonym(pseudonym)) return false;
  database_.prepare("DELETE FROM identity WHERE pseudonym = ?").bind(1, pseudonym).run();
  return true;
}

}  // namespace cavum::records
