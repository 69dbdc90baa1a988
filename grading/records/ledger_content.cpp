#include "grading/records/ledger_content.h"

#include <fmt/core.h>

#include <filesystem>
#include <set>

#include "engine/session/session.h"
#include "engine/session/session_image.h"
#include "grading/records/entry_text.h"
#include "grading/records/erasure.h"
#include "grading/records/history.h"
#include "grading/records/ledger_error.h"
#include "grading/records/ledger_file.h"
#include "grading/records/ledger_key.h"
#include "grading/records/merkle.h"
#include "grading/records/school_keys.h"
#include "grading/records/witness.h"

namespace cavum::records {
namespace {

/// What the row says, as far as it can be read; else a finding.
LedgerEntry parse_entry(std::uint64_t seq, const std::string& text, const Sha256& leaf,
                        Findings& findings) {
  if (leaf_hash(ledger_bytes(text)) != leaf)
    findings.push_back(finding<FindingKind::entry_changed>().in_entry(seq));
  LedgerEntry e;
  try {
    e = read_entry(text, msg("entry {}", seq));
    if (entry_text(e) != text)
      findings.push_back(finding<FindingKind::entry_malformed>().in_entry(seq));
    if (e.seq != seq)
      findings.push_back(finding<FindingKind::entry_out_of_order>(e.seq).in_entry(seq));
    if (e.as<InitEntry>() != nullptr && seq != 0)
      findings.push_back(finding<FindingKind::begins_again>().in_entry(seq));
  } catch (const Error& wrong) {
    findings.push_back(finding<FindingKind::entry_unreadable>(wrong.problem()).in_entry(seq));
    e.text = text;
  }
  e.seq = seq;
  e.leaf = leaf;
  return e;
}

/// A table that was taken out is a finding of check_schema; the others are read all the same.
bool has_table(Database& db, const std::string& name) {
  return db.integer(
             fmt::format("SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = '{}'",
                         name)
                 .c_str()) == 1;
}

/// Puts what openings hold into the entries. Each must be as it was bound, named by one entry, and
/// be gone when, and only when, an entry says so.
void take_openings(LedgerContent& c, const std::map<std::string, std::string>& stored) {
  c.erased = read_erased(c.entries, c.findings);
  std::set<std::string> named;
  for (auto& e : c.entries) {
    if (!e.what) continue;
    for (const auto& [part, opening] : openings_of(*e.what)) {
      const Term name{word_of(part)};
      const auto found = stored.find(opening->sha256);
      const bool there = found != stored.end();
      const auto by = erased_by(c.erased, e.seq, part);
      named.insert(opening->sha256);
      if (!there && !by)
        c.findings.push_back(finding<FindingKind::part_missing>(name).in_entry(e.seq));
      if (there && by)
        c.findings.push_back(finding<FindingKind::part_there_again>(name, *by).in_entry(e.seq));
      if (!there) continue;
      try {
        opening->value = opened_value(found->second, opening->sha256, msg("opening"));
      } catch (const Error&) {
        c.findings.push_back(finding<FindingKind::part_changed>(name).in_entry(e.seq));
      }
    }
  }
  for (const auto& [hash, text] : stored)
    if (!named.contains(hash)) c.findings.push_back(finding<FindingKind::opening_foreign>(hash));
}

std::map<std::string, std::string> stored_openings(Database& db) {
  std::map<std::string, std::string> out;
  if (!has_table(db, "opening")) return out;
  auto rows = db.prepare("SELECT sha256, text FROM opening");
  while (rows.step()) out[rows.text(0)] = rows.text(1);
  return out;
}

/// Each as it was put there, each named by an entry, and none missing.
void read_documents(Database& db, LedgerContent& c) {
  if (has_table(db, "document")) {
    auto rows = db.prepare("SELECT sha256, bytes FROM document ORDER BY sha256");
    while (rows.step()) {
      const std::string hash = to_hex(rows.fixed_blob<32>(0));
      Bytes bytes = rows.blob(1);
      if (to_hex(sha256(bytes)) != hash)
        c.findings.push_back(finding<FindingKind::document_changed>(hash));
      c.documents[hash] = std::move(bytes);
    }
  }
  std::set<std::string> named;
  for (const auto& e : c.entries)
    if (const auto* regrade = e.as<RegradeEntry>())
      for (const auto& [name, hash] : regrade->by) {
        named.insert(hash);
        if (!c.documents.contains(hash))
          c.findings.push_back(finding<FindingKind::document_missing>(name).in_entry(e.seq));
      }
  for (const auto& [hash, bytes] : c.documents)
    if (!named.contains(hash)) c.findings.push_back(finding<FindingKind::document_foreign>(hash));
}

/// Notes and cosignatures as they are stored; read when the ledger's id and key are known.
struct StoredNotes {
  std::vector<std::pair<std::uint64_t, std::string>> notes, cosignatures;
};
StoredNotes stored_notes(Database& db) {
  StoredNotes out;
  const auto read = [&](const char* table, const char* sql, auto& into) {
    if (!has_table(db, table)) return;
    auto rows = db.prepare(sql);
    while (rows.step())
      into.emplace_back(static_cast<std::uint64_t>(rows.integer(0)), rows.text(1));
  };
  read("note", "SELECT size, text FROM note ORDER BY size", out.notes);
  read("cosignature", "SELECT size, line FROM cosignature ORDER BY size, line", out.cosignatures);
  return out;
}

void take_notes(LedgerContent& c, const StoredNotes& stored) {
  for (const auto& [size, text] : stored.notes) {
    const Message name = msg("checkpoint {}", size);
    try {
      const ReadCheckpoint read = parse_checkpoint(text, c.key_of(size), name);
      if (read.ledger_id != c.id || read.checkpoint.size != size ||
          text != checkpoint_note(c.id, c.key_of(size), read.checkpoint))
        c.findings.push_back(finding<FindingKind::note_changed>(size));
      c.checkpoints.push_back(read.checkpoint);
    } catch (const Error& e) {
      c.findings.push_back(finding<FindingKind::malformed>(e.where_and_problem()));
    }
  }
  for (const auto& [size, line] : stored.cosignatures) {
    const Message name = msgn("cosignature under {} entry", "cosignature under {} entries",
                              static_cast<std::int64_t>(size), size);
    try {
      c.cosignatures.push_back({size, parse_signature_line(line, name)});
    } catch (const Error& e) {
      c.findings.push_back(finding<FindingKind::malformed>(e.where_and_problem()));
    }
  }
}

}  // namespace

LedgerEntry make_entry(std::uint64_t seq, Entry what, Actor by) {
  LedgerEntry e;
  e.seq = seq;
  e.utc_ns = read_clocks().utc_ns;
  e.by = std::move(by);
  e.what = std::move(what);
  e.text = entry_text(e);
  static_cast<void>(
      read_entry(e.text, msg("entry {}", seq)));  // nothing is entered that could not be read
  e.leaf = leaf_hash(ledger_bytes(e.text));
  return e;
}

std::vector<Sha256> leaves_of(const LedgerContent& c) {
  std::vector<Sha256> leaves;
  for (const auto& e : c.entries) leaves.push_back(e.leaf);
  return leaves;
}

std::vector<NoteSignature> cosignatures_of(const LedgerContent& c, std::uint64_t size) {
  std::vector<NoteSignature> out;
  for (const auto& s : c.cosignatures)
    if (s.size == size) out.push_back(s.by);
  return out;
}

LedgerContent read_content(Database& db, const std::string& where, AskWitness ask) {
  require_ledger(db, where);
  LedgerContent c;
  check_schema(db, c.findings);
  // The witness first: it is told after each entry, so what it knows by now is in the database by
  // then. One snapshot of the tables for the same reason.
  const bool has_entries = has_table(db, "entry");
  const std::string first = has_entries ? db.text("SELECT text FROM entry WHERE seq = 0") : "";
  const LedgerEntry begin = read_entry_or_none(first);
  const auto* named = begin.as<InitEntry>();
  const std::string id = named == nullptr ? "" : named->ledger;
  const bool known = ask == AskWitness::yes && id.size() == 32 && id.find('/') == std::string::npos;
  const auto witnessed = known ? read_witness(id, c.findings) : std::vector<Checkpoint>();
  const bool alone = !db.in_transaction();
  if (alone) db.run("BEGIN");
  if (has_entries) {
    auto rows = db.prepare("SELECT seq, text, leaf_sha256 FROM entry ORDER BY seq");
    for (std::uint64_t expected = 0; rows.step(); ++expected) {
      const auto seq = static_cast<std::uint64_t>(rows.integer(0));
      if (seq != expected)
        c.findings.push_back(finding<FindingKind::entry_missing>().in_entry(expected));
      expected = seq;
      c.entries.push_back(parse_entry(seq, rows.text(1), rows.fixed_blob<32>(2), c.findings));
    }
  }
  const StoredNotes notes = stored_notes(db);
  const auto openings = stored_openings(db);
  read_documents(db, c);
  if (alone) db.run("COMMIT");
  take_openings(c, openings);
  const auto* init = c.entries.empty() ? nullptr : c.entries[0].as<InitEntry>();
  if (init == nullptr) {
    c.findings.push_back(finding<FindingKind::no_beginning>().in_entry(0));
    return c;
  }
  c.id = init->ledger;
  c.school = init->school;
  read_school_keys(c);
  take_notes(c, notes);
  check_checkpoints(c);
  check_witness(c, witnessed);
  std::int64_t before = 0;
  for (const auto& e : c.entries) {
    if (e.utc_ns < before)
      c.remarks.push_back(finding<FindingKind::clock_set_back>().in_entry(e.seq));
    before = e.utc_ns;
  }
  return c;
}

bool holds_parts_of_a_ledger(const LedgerPaths& places) {
  std::error_code none;
  const std::filesystem::directory_iterator sessions(places.folder + "/sessions", none);
  return std::filesystem::exists(places.identities(), none) ||
         sessions != std::filesystem::directory_iterator();
}

LedgerContent read_ledger(const LedgerPaths& places, AskWitness ask) {
  if (!std::filesystem::exists(places.database()))
    throw Error(code_of_none(places.database()), Name{places.folder}, msg("holds no ledger"),
                instead_of_none(places.database()));
  try {
    Database live = Database::open(places.database(), false, k_long_wait);
    return read_content(live, places.database(), ask);
  } catch (const DatabaseError&) {  // a folder that may only be read, or damage: then from a copy
                                    // in memory
  }
  const auto from_copy = [&] {
    Damages left_out;
    Database copy =
        Database::from_image(read_session_image(places.database(), left_out), places.database());
    Findings read;
    for (const Damage& d : left_out) read.push_back(finding<FindingKind::read_failed>(d.message()));
    try {
      LedgerContent c = read_content(copy, places.database(), AskWitness::no);
      append(read, c.findings);
      c.findings = std::move(read);
      return c;
    } catch (const DatabaseError& e) {
      LedgerContent damaged;
      damaged.findings = schema_findings(copy);  // the cause, when tables were altered
      if (damaged.findings.empty())
        damaged.findings.push_back(finding<FindingKind::read_failed>(e.message()));
      return damaged;
    }
  };
  LedgerContent c = from_copy();
  if (ask == AskWitness::no || c.id.size() != 32) return c;
  // The witness first, as above, for others may add meanwhile; it is known whose it is only now.
  Findings changed;
  const auto witnessed = read_witness(c.id, changed);
  c = from_copy();
  append(c.findings, changed);
  if (c.id.size() == 32) check_witness(c, witnessed);
  return c;
}

}  // namespace cavum::records
