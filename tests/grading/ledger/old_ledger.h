// A ledger as an older version of the program left it: its tables, and checkpoints signed as that version signed them.
#pragma once

#include "grading/ledger/ledger_file.h"
#include "grading/ledger/witness.h"
#include "tests/grading/ledger/school.h"

namespace cavum::testing_ledger {

/// The tables of formats 1, 2 and 3 as they were written then: each adds to the one before.
inline constexpr std::array<const char*, 3> k_old_tables = {
    R"(CREATE TABLE entry (      -- append only
  seq INTEGER PRIMARY KEY,   -- 0, 1, 2 ...
  text TEXT NOT NULL,        -- {"body":...,"kind":...,"seq":...,"utc_ns":...}: the leaf of the tree
  leaf_sha256 BLOB NOT NULL, -- SHA-256(0x00 || text)
  attachment TEXT            -- a result (JSON), bound by text's body.result_sha256: a receipt shows the text, and no marks
) STRICT;
CREATE TABLE checkpoint (    -- one after each entry: the school's signature over the tree so far
  size INTEGER PRIMARY KEY,  -- number of entries, 1, 2, 3 ...
  root_sha256 BLOB NOT NULL,
  utc_ns INTEGER NOT NULL,   -- since 1970
  signature BLOB NOT NULL    -- Ed25519
) STRICT;
CREATE TRIGGER entry_stays BEFORE UPDATE ON entry BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER entry_is_kept BEFORE DELETE ON entry BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER checkpoint_stays BEFORE UPDATE ON checkpoint BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER checkpoint_is_kept BEFORE DELETE ON checkpoint BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;)",
    R"(CREATE VIEW session AS SELECT seq, text ->> '$.body.candidate' AS candidate, text ->> '$.body.scenario_id' AS scenario,
  text ->> '$.body.file_sha256' AS file_sha256, attachment ->> '$.verdict' AS verdict, attachment ->> '$.score.points' AS points,
  attachment ->> '$.score.max' AS points_max FROM entry WHERE text ->> '$.kind' = 'session';
CREATE VIEW ticket AS SELECT seq, text ->> '$.body.ticket.candidate' AS candidate, text ->> '$.body.ticket.exam' AS scenario,
  text ->> '$.body.ticket.nonce' AS nonce, text ->> '$.body.ticket.not_before' AS not_before, text ->> '$.body.ticket.not_after' AS not_after
  FROM entry WHERE text ->> '$.kind' = 'ticket';)",
    R"(CREATE TABLE document (   -- what results were marked anew by: rubrics, scenarios and their STL files, each once
  sha256 BLOB PRIMARY KEY,   -- of its bytes; the regrade's text names it under body.by
  bytes BLOB NOT NULL
) STRICT;
CREATE TRIGGER document_stays BEFORE UPDATE ON document BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER document_is_kept BEFORE DELETE ON document BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;)"};

/// Writes the school's ledger anew as a version of `format` (1 to 3) would have left it: the same entries, signed as "CVCHKPT1".
inline void make_old(const School& school, int format) {
  ledger::LedgerContent now = ledger::read_ledger(school.places());
  for (auto& e : now.entries) {  // results lay beside their entries
    nlohmann::json told = e.body;
    told.erase("opens");
    if (const auto result = e.opened.find("result"); result != e.opened.end()) {
      e.attachment = result->second->dump();
      told["result_sha256"] = to_hex(sha256(e.attachment));
    }
    e.text = nlohmann::json{{"body", told}, {"kind", e.kind}, {"seq", e.seq}, {"utc_ns", e.utc_ns}}.dump();
    e.leaf = ledger::leaf_hash(ledger::ledger_bytes(e.text));
  }
  const auto leaves = ledger::leaves_of(now);
  for (auto& p : now.checkpoints) p.root = ledger::merkle_root(std::span(leaves).first(p.size));
  std::filesystem::remove(ledger::witness_path(now.id));  // of another history
  for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(school.places().database() + end);
  Database old = Database::open(school.places().database(), true);
  old.run("PRAGMA application_id = 1130460748");
  for (int i = 0; i < format; ++i) old.run(k_old_tables.at(static_cast<std::size_t>(i)));
  old.run(("PRAGMA user_version = " + std::to_string(format)).c_str());
  for (const auto& e : now.entries)
    old.prepare("INSERT INTO entry VALUES (?, ?, ?, nullif(?, ''))")
        .bind(1, static_cast<std::int64_t>(e.seq))
        .bind(2, e.text)
        .bind(3, e.leaf)
        .bind(4, e.attachment)
        .run();
  for (const auto& p : now.checkpoints)
    old.prepare("INSERT INTO checkpoint VALUES (?, ?, ?, ?)")
        .bind(1, static_cast<std::int64_t>(p.size))
        .bind(2, p.root)
        .bind(3, p.utc_ns)
        .bind(4, School::key().sign(ledger::checkpoint_message(now.id, p)))
        .run();
  if (format >= 3)
    for (const auto& [hash, bytes] : now.documents) old.prepare("INSERT INTO document VALUES (?, ?)").bind(1, sha256(bytes)).bind(2, bytes).run();
}

}  // namespace cavum::testing_ledger
