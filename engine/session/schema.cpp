#include "engine/session/schema.h"

namespace cavum {

// STRICT: SQLite itself then refuses a value of another type. Autoindexes are avoided (WITHOUT
// ROWID, integer keys), so that every value exists once in the file and cannot disagree with a copy
// of itself.
const std::array<const char*, 6> k_session_schema = {
    R"(CREATE TABLE meta (  -- who, when, with what; one row per fact. Covered by the chain's start
  key TEXT PRIMARY KEY,
  value TEXT NOT NULL
) STRICT, WITHOUT ROWID)",
    R"(CREATE TABLE artifact (  -- files kept whole: scenario, tooth, burs, force model, servo settings
  seq INTEGER PRIMARY KEY,
  name TEXT NOT NULL,       -- final_tooth.cvt is written on closing, all others before the first tick
  sha256 BLOB NOT NULL,     -- of bytes
  size_bytes INTEGER NOT NULL,
  bytes BLOB NOT NULL
) STRICT)",
    R"(CREATE TABLE chunk (  -- up to one second of motion per row, written in one transaction
  seq INTEGER PRIMARY KEY,        -- 0, 1, 2 ...
  first_tick INTEGER NOT NULL,    -- number of the first tick, from 0; meta.tick_s is the length of a tick
  ticks INTEGER NOT NULL,         -- 0..1000; 0 = events only
  inputs BLOB NOT NULL,           -- what the servo consumed, packed: tip nm, rotation 2^-30, pedal 1/65535, flags, bur
  records BLOB NOT NULL,          -- what it gave, packed: force uN, penetration nm, proxy nm, rpm, leaves removed, notices
  removed BLOB NOT NULL,          -- leaves removed per tick, packed: x, y, z in leaves of the tooth, tissue id
  state_hash INTEGER NOT NULL,    -- of the servo's state after the last tick (64 bits, two's complement)
  monotonic_ns INTEGER NOT NULL,  -- clocks when the chunk was complete; this one stops in suspend
  boot_ns INTEGER NOT NULL,       -- this one does not
  utc_ns INTEGER NOT NULL,        -- since 1970, may be set by people
  inputs_sha256 BLOB NOT NULL,    -- of inputs
  records_sha256 BLOB NOT NULL,   -- of records
  removed_sha256 BLOB NOT NULL,   -- of removed
  events_sha256 BLOB NOT NULL,    -- of the events committed with this chunk
  prev_sha256 BLOB NOT NULL,      -- sha256 of the chunk before; for the first one the hash of meta and artifacts
  sha256 BLOB NOT NULL            -- link of the chain: prev_sha256, numbers, clocks and the four hashes above
) STRICT)",
    R"(CREATE TABLE event (  -- what happened, in order
  seq INTEGER PRIMARY KEY,  -- 0, 1, 2 ...
  tick INTEGER NOT NULL,
  chunk INTEGER NOT NULL REFERENCES chunk (seq),  -- committed and hashed with this chunk
  kind TEXT NOT NULL,
  detail_json TEXT NOT NULL
) STRICT)",
    R"(CREATE TABLE result (  -- the exam's own result, one row, written on closing
  seq INTEGER PRIMARY KEY,
  json TEXT NOT NULL
) STRICT)",
    R"(CREATE TABLE seal (  -- one row, written on closing; without it the session was interrupted
  seq INTEGER PRIMARY KEY,
  chain_sha256 BLOB NOT NULL,        -- sha256 of the last chunk
  final_tooth_sha256 BLOB NOT NULL,  -- of artifact final_tooth.cvt
  result_sha256 BLOB NOT NULL,       -- of result.json
  chunks INTEGER NOT NULL,
  ticks INTEGER NOT NULL,
  events INTEGER NOT NULL,
  monotonic_ns INTEGER NOT NULL,
  boot_ns INTEGER NOT NULL,
  utc_ns INTEGER NOT NULL,
  public_key BLOB NOT NULL,          -- Ed25519, of the station
  signature BLOB NOT NULL            -- Ed25519 over all of the above
) STRICT)"};

}  // namespace cavum
