// The ledger's tables, and how older files become the present ones: step i takes format i to format i + 1.
#pragma once

#include <array>

namespace cavum::ledger {

inline constexpr std::array<const char*, 5> k_ledger_migrations = {
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
    // for people who look with sqlite3
    R"(CREATE VIEW session AS SELECT seq, text ->> '$.body.candidate' AS candidate, text ->> '$.body.scenario_id' AS scenario,
  text ->> '$.body.file_sha256' AS file_sha256, attachment ->> '$.verdict' AS verdict, attachment ->> '$.score.points' AS points,
  attachment ->> '$.score.max' AS points_max FROM entry WHERE text ->> '$.kind' = 'session';
CREATE VIEW ticket AS SELECT seq, text ->> '$.body.ticket.candidate' AS candidate, text ->> '$.body.ticket.exam' AS scenario,
  text ->> '$.body.ticket.nonce' AS nonce, text ->> '$.body.ticket.not_before' AS not_before, text ->> '$.body.ticket.not_after' AS not_after
  FROM entry WHERE text ->> '$.kind' = 'ticket';)",
    // a regrade's result can be made again without any file from elsewhere
    R"(CREATE TABLE document (   -- what results were marked anew by: rubrics, scenarios and their STL files, each once
  sha256 BLOB PRIMARY KEY,   -- of its bytes; the regrade's text names it under body.by
  bytes BLOB NOT NULL
) STRICT;
CREATE TRIGGER document_stays BEFORE UPDATE ON document BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER document_is_kept BEFORE DELETE ON document BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;)",
    // what the school signs can be checked by any program, and others can sign it, too
    R"(CREATE TABLE note (       -- the checkpoint after each entry, as a C2SP signed note; table checkpoint holds those of before
  size INTEGER PRIMARY KEY,  -- number of entries
  text TEXT NOT NULL
) STRICT;
CREATE TABLE cosignature (   -- what other parties have signed of the notes; bound by nothing: anybody may take it out
  size INTEGER NOT NULL,
  line TEXT NOT NULL,        -- of the signature, with its line end
  PRIMARY KEY (size, line)
) STRICT;
CREATE TRIGGER note_stays BEFORE UPDATE ON note BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER note_is_kept BEFORE DELETE ON note BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER cosignature_stays BEFORE UPDATE ON cosignature BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER cosignature_is_kept BEFORE DELETE ON cosignature BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;)",
    // what is about a person can be erased, and every proof stays valid
    R"(CREATE TABLE opening (    -- what can be erased: entries name its hash
  sha256 TEXT PRIMARY KEY,   -- of text, hexadecimal
  text TEXT NOT NULL         -- {"salt":"32 hex digits","value":...}
) STRICT;
CREATE TRIGGER opening_stays BEFORE UPDATE ON opening BEGIN SELECT RAISE(ABORT, 'an opening may only be erased'); END;
DROP TRIGGER entry_stays;
CREATE TRIGGER entry_stays BEFORE UPDATE OF seq, text, leaf_sha256 ON entry BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER attachment_stays BEFORE UPDATE OF attachment ON entry WHEN NEW.attachment IS NOT NULL
  BEGIN SELECT RAISE(ABORT, 'a result may only be erased'); END;
DROP VIEW session;
CREATE VIEW session AS SELECT e.seq, e.text ->> '$.body.candidate' AS candidate, e.text ->> '$.body.scenario_id' AS scenario,
  e.text ->> '$.body.file_sha256' AS file_sha256, coalesce(e.attachment ->> '$.verdict', o.text ->> '$.value.verdict') AS verdict,
  coalesce(e.attachment ->> '$.score.points', o.text ->> '$.value.score.points') AS points,
  coalesce(e.attachment ->> '$.score.max', o.text ->> '$.value.score.max') AS points_max
  FROM entry e LEFT JOIN opening o ON o.sha256 = e.text ->> '$.body.opens.result' WHERE e.text ->> '$.kind' = 'session';)"};

}  // namespace cavum::ledger
