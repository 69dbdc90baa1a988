// The ledger's tables. A ledger's file has these and no others.
#pragma once

namespace cavum::records {

inline constexpr char k_ledger_schema[] =
    R"(CREATE TABLE entry (       -- append only
  seq INTEGER PRIMARY KEY,    -- 0, 1, 2 ...
  text TEXT NOT NULL,         -- {"body":...,"kind":...,"seq":...,"utc_ns":...}: the leaf of the tree
  leaf_sha256 BLOB NOT NULL   -- SHA-256(0x00 || text)
) STRICT;
CREATE TABLE opening (        -- what can be erased: entries name its hash
  sha256 TEXT PRIMARY KEY,    -- of text, hexadecimal
  text TEXT NOT NULL          -- {"salt":"32 hex digits","value":...}
) STRICT;
CREATE TABLE document (       -- what results were marked anew by: rubrics, scenarios and their STL files, each once
  sha256 BLOB PRIMARY KEY,    -- of its bytes; the regrade's text names it under body.by
  bytes BLOB NOT NULL
) STRICT;
CREATE TABLE note (           -- one after each entry: the checkpoint, a C2SP signed note
  size INTEGER PRIMARY KEY,   -- number of entries, 1, 2, 3 ...
  text TEXT NOT NULL
) STRICT;
CREATE TABLE cosignature (    -- what other parties have signed of the notes; bound by nothing: anybody may take it out
  size INTEGER NOT NULL,
  line TEXT NOT NULL,         -- of the signature, with its line end
  PRIMARY KEY (size, line)
) STRICT;
CREATE TRIGGER entry_stays BEFORE UPDATE ON entry BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER entry_is_kept BEFORE DELETE ON entry BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER opening_stays BEFORE UPDATE ON opening BEGIN SELECT RAISE(ABORT, 'an opening may only be erased'); END;
CREATE TRIGGER document_stays BEFORE UPDATE ON document BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER document_is_kept BEFORE DELETE ON document BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER note_stays BEFORE UPDATE ON note BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER note_is_kept BEFORE DELETE ON note BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER cosignature_stays BEFORE UPDATE ON cosignature BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE TRIGGER cosignature_is_kept BEFORE DELETE ON cosignature BEGIN SELECT RAISE(ABORT, 'the ledger is append only'); END;
CREATE VIEW session AS SELECT e.seq, e.text ->> '$.body.candidate' AS candidate, e.text ->> '$.body.scenario_id' AS scenario,
  e.text ->> '$.body.file_sha256' AS file_sha256, o.text ->> '$.value.verdict' AS verdict, o.text ->> '$.value.score.points' AS points,
  o.text ->> '$.value.score.max' AS points_max
  FROM entry e LEFT JOIN opening o ON o.sha256 = e.text ->> '$.body.opens.result' WHERE e.text ->> '$.kind' = 'session';
CREATE VIEW ticket AS SELECT seq, text ->> '$.body.ticket.candidate' AS candidate, text ->> '$.body.ticket.exam' AS scenario,
  text ->> '$.body.ticket.nonce' AS nonce, text ->> '$.body.ticket.not_before' AS not_before, text ->> '$.body.ticket.not_after' AS not_after
  FROM entry WHERE text ->> '$.kind' = 'ticket';)";

}  // namespace cavum::records
