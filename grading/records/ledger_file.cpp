#include "grading/records/ledger_file.h"

#include <fmt/core.h>

#include <filesystem>
#include <map>

#include "grading/records/entry_text.h"
#include "grading/records/ledger_error.h"
#include "grading/records/ledger_schema.h"

namespace cavum::records {
namespace {

/// What a database defines, by name: "table entry" and its SQL. What SQLite keeps for itself is
/// left out.
std::map<std::string, std::string> schema_of(Database& db) {
  std::map<std::string, std::string> out;
  auto rows = db.prepare(
      "SELECT type, name, coalesce(sql, '') FROM sqlite_schema WHERE name NOT LIKE 'sqlite\\_%' ESCAPE '\\' ORDER BY rowid");
  while (rows.step()) out[fmt::format("{} {}", rows.text(0), rows.text(1))] = rows.text(2);
  return out;
}

}  // namespace

LedgerError code_of_none(const std::string& path) {
  return holds_parts_of_a_ledger({std::filesystem::path(path).parent_path().string()})
             ? LedgerError::lost
             : LedgerError::unknown;
}

Message instead_of_none(const std::string& path) {
  if (code_of_none(path) == LedgerError::lost)
    return msg(
        "restore ledger.db from its backup: the ledger's sessions or identities are still here");
  return msg("make one with `cavum ledger init FOLDER`");
}

void require_ledger(Database& db, const std::string& where) {
  if (db.integer("PRAGMA application_id") != k_ledger_application_id) {
    std::error_code none;
    const bool empty = std::filesystem::file_size(where, none) == 0 && !none;
    throw Error(code_of_none(where), Name{where}, empty ? msg("is empty") : msg("is no ledger"),
                instead_of_none(where));
  }
  if (const auto format = db.integer("PRAGMA user_version"); format != k_ledger_format)
    throw Error(
        where,
        msg("is of format {}, and this version of Cavum reads format {}", format, k_ledger_format),
        msg("use the version that wrote it"));
}

void check_schema(Database& db, Findings& findings) {
  Database fresh = Database::open(":memory:", true);
  fresh.run(k_ledger_schema);
  const auto wanted = schema_of(fresh), found = schema_of(db);
  for (const auto& [name, sql] : wanted) {
    const auto is = found.find(name);
    if (is == found.end())
      findings.push_back(finding<FindingKind::schema_missing>(name));
    else if (is->second != sql)
      findings.push_back(finding<FindingKind::schema_differs>(name));
  }
  for (const auto& [name, sql] : found)
    if (!wanted.contains(name)) findings.push_back(finding<FindingKind::schema_added>(name));
}

Findings schema_findings(Database& db) noexcept {
  try {
    Findings findings;
    check_schema(db, findings);
    return findings;
  } catch (const std::exception&) {
    return {};
  }
}

void make_tables(Database& db) {
  Transaction all(db);
  db.run(fmt::format("PRAGMA application_id = {}", k_ledger_application_id).c_str());
  db.run(k_ledger_schema);
  db.run(fmt::format("PRAGMA user_version = {}", k_ledger_format).c_str());
  all.commit();
}

Database open_for_adding(const std::string& path, bool make) {
  if (!make && !std::filesystem::exists(path))
    throw Error(code_of_none(path), Name{path}, msg("there is no ledger"), instead_of_none(path));
  std::error_code none;  // an empty file would become a database below
  if (!make && std::filesystem::file_size(path, none) == 0 && !none)
    throw Error(code_of_none(path), Name{path}, msg("is empty"), instead_of_none(path));
  Database db = Database::open(path, make, k_long_wait);
  db.run("PRAGMA journal_mode = WAL");
  db.run("PRAGMA synchronous = FULL");
  db.run("PRAGMA secure_delete = ON");
  return db;
}

void insert(Database& db, const LedgerEntry& e, std::span<const std::string> erases,
            const std::string& note, std::span<const Bytes> documents) {
  for (const Bytes& d : documents)
    db.prepare("INSERT OR IGNORE INTO document (sha256, bytes) VALUES (?, ?)")
        .bind(1, sha256(d))
        .bind(2, d)
        .run();
  db.prepare("INSERT INTO entry (seq, text, leaf_sha256) VALUES (?, ?, ?)")
      .bind(1, static_cast<std::int64_t>(e.seq))
      .bind(2, e.text)
      .bind(3, e.leaf)
      .run();
  for (const auto& [part, o] : openings_of(e.what.value()))
    db.prepare("INSERT INTO opening (sha256, text) VALUES (?, ?)")
        .bind(1, o->sha256)
        .bind(2, o->text)
        .run();
  for (const auto& hash : erases)
    db.prepare("DELETE FROM opening WHERE sha256 = ?").bind(1, hash).run();
  db.prepare("INSERT INTO note (size, text) VALUES (?, ?)")
      .bind(1, static_cast<std::int64_t>(e.seq + 1))
      .bind(2, note)
      .run();
}

void wipe_erased(Database& db, const std::string& where) {
  if (db.integer("PRAGMA wal_checkpoint(TRUNCATE)") != 0)
    throw Error(LedgerError::in_use, Name{where},
                msg("what was erased is still in its log, which another program is reading"),
                msg("end that program, and run `cavum ledger erase` again"));
}

void insert_cosignature(Database& db, std::uint64_t size, const std::string& line) {
  db.prepare("INSERT OR IGNORE INTO cosignature (size, line) VALUES (?, ?)")
      .bind(1, static_cast<std::int64_t>(size))
      .bind(2, line)
      .run();
}

}  // namespace cavum::records
