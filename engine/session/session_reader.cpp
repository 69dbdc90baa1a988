#include "engine/session/session_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <set>

#include "engine/base/error.h"
#include "engine/physics/servo/servo.h"
#include "engine/session/schema.h"
#include "engine/session/session_error.h"
#include "engine/session/session_image.h"
#include "engine/session/sqlite.h"

namespace cavum {
namespace {

constexpr std::size_t k_max_rows = 2'000'000;  // of one table; a day of motion has 86,400 chunks

std::int64_t header_number(const Bytes& image, std::size_t at) {
  return static_cast<std::int64_t>(image[at]) << 24 | image[at + 1] << 16 | image[at + 2] << 8 |
         image[at + 3];
}

/// Reads one table row by row; damage in it is one finding and leaves the other tables alone. Keys
/// must rise, so that pages which refer to one another in a circle cannot go on for ever.
template <class Row>
void read_table(Database& database, const char* table, const std::string& columns,
                Damages& findings, const Row& row) {
  std::size_t rows = 0;
  try {
    Statement s =
        database.prepare(fmt::format("SELECT {} FROM {} ORDER BY 1", columns, table).c_str());
    for (; s.step(); ++rows) {
      if (rows == k_max_rows)
        throw Error(table, msg("has more rows than any session"), msg("use an intact copy"));
      row(s);
    }
  } catch (const Error& e) {
    findings.push_back(damage<DamageKind::row_unreadable>(table, rows, e.where_and_problem()));
  }
}

std::int64_t rising(const Statement& s, std::int64_t expected, const char* table) {
  const std::int64_t seq = s.integer(0);
  if (seq != expected)
    throw Error(table, msg("number {} is missing or moved (found {})", expected, seq),
                msg("use an intact copy"));
  return seq;
}

void check_schema(Database& database, Damages& findings) {
  std::size_t i = 0;
  Statement s = database.prepare("SELECT type, name, sql FROM sqlite_schema ORDER BY rowid");
  for (; s.step(); ++i)
    if (i >= k_session_schema.size() || s.text(0) != "table" || s.text(2) != k_session_schema[i])
      throw Error(msg("schema"),
                  msg("'{}' is not a table of a session of format {}", s.text(1), k_session_format),
                  msg("use an intact copy"));
  if (i != k_session_schema.size())
    throw Error(msg("schema"), msg("a table is missing"), msg("use an intact copy"));
  if (const auto v = database.integer("PRAGMA user_version"); v != k_session_format)
    findings.push_back(damage<DamageKind::user_version>(v, k_session_format));
  if (database.integer("PRAGMA application_id") != k_session_application_id)
    findings.push_back(damage<DamageKind::application_id>());
}

void quick_check(Database& database, Damages& findings) {
  try {
    Statement s = database.prepare("PRAGMA quick_check(10)");
    while (s.step())
      if (const std::string line = s.text(0); line != "ok")
        findings.push_back(damage<DamageKind::database_damaged>(line));
  } catch (const DatabaseError& e) {
    findings.push_back(damage<DamageKind::database_damaged>(e.where_and_problem()));
  }
}

Clocks clocks_at(const Statement& s, int column) {
  return {s.integer(column), s.integer(column + 1), s.integer(column + 2)};
}

/// A row of table chunk, which must be number `expected`.
ChunkRow chunk_at(const Statement& row, std::int64_t expected) {
  ChunkRow c;
  c.seq = rising(row, expected, "chunk");
  c.first_tick = row.integer(1);
  c.ticks = row.integer(2);
  c.inputs = row.blob(3);
  c.records = row.blob(4);
  c.removed = row.blob(5);
  c.state_hash = static_cast<std::uint64_t>(row.integer(6));
  c.clocks = clocks_at(row, 7);
  c.inputs_sha256 = row.fixed_blob<32>(10);
  c.records_sha256 = row.fixed_blob<32>(11);
  c.removed_sha256 = row.fixed_blob<32>(12);
  c.events_sha256 = row.fixed_blob<32>(13);
  c.prev_sha256 = row.fixed_blob<32>(14);
  c.sha256 = row.fixed_blob<32>(15);
  return c;
}

std::vector<TickInput> inputs_in(const ChunkRow& c, const std::string& path) {
  return unpack_inputs(c.inputs, c.ticks, msg("{}: chunk {}, inputs", path, c.seq));
}
std::vector<TickRecord> records_in(const ChunkRow& c, const std::string& path) {
  return unpack_records(c.records, c.ticks, msg("{}: chunk {}, records", path, c.seq));
}
RemovedTicks removed_in(const ChunkRow& c, const std::string& path) {
  return unpack_removed(c.removed, c.ticks, msg("{}: chunk {}, removed leaves", path, c.seq));
}

}  // namespace

SessionReader::SessionReader(const std::string& path) : path_(path) {
  read(read_session_image(path, findings_));
}

SessionReader::SessionReader(Bytes file, const std::string& name) : path_(name) {
  require_session_image(file, name);
  read(std::move(file));
}

void SessionReader::read(Bytes image) {
  const bool marked = header_number(image, 68) == k_session_application_id;
  Database database = Database::from_image(std::move(image), path_);
  try {
    check_schema(database, findings_);
  } catch (const Error& e) {
    if (!marked)
      throw Error(SessionError::not_a_session, Name{path_},
                  msg("is an SQLite database, but not a Cavum session"),
                  msg("name a .cavum file that an exam wrote"));
    findings_.push_back(damage<DamageKind::database_damaged>(e.where_and_problem()));
    return;  // with tables of another shape, every query would be a guess
  }
  quick_check(database, findings_);
  read_table(database, "meta", "key, value", findings_,
             [&](const Statement& row) { meta_.emplace(row.text(0), row.text(1)); });
  read_artifacts(database);
  read_chunks(database);
  std::int64_t next_event = 0;
  read_table(database, "event", "seq, tick, chunk, kind, detail_json", findings_,
             [&](const Statement& row) {
               const auto seq = rising(row, next_event++, "event");
               try {
                 events_.push_back({{row.integer(1), decode({row.text(3), row.text(4)},
                                                            msg("table event, row {}", seq))},
                                    seq,
                                    row.integer(2)});
               } catch (const DatabaseError&) {
                 throw;
               } catch (const Error& e) {
                 findings_.push_back(damage<DamageKind::event_unreadable>(e.message()));
               }
             });
  read_table(database, "result", "seq, json", findings_, [&](const Statement& row) {
    rising(row, 0, "result");
    result_json_ = row.text(1);
  });
  read_seal(database);
}

void SessionReader::read_artifacts(Database& database) {
  std::set<std::string> names;
  read_table(database, "artifact", "seq, name, sha256, size_bytes, bytes", findings_,
             [&](const Statement& row) {
               rising(row, static_cast<std::int64_t>(artifacts_.size()), "artifact");
               Artifact a{row.text(1), row.fixed_blob<32>(2), row.blob(4)};
               if (!names.insert(a.name).second)
                 throw Error(msg("artifact"), msg("'{}' is there twice", a.name),
                             msg("use an intact copy"));
               if (row.integer(3) != static_cast<std::int64_t>(a.bytes.size()))
                 findings_.push_back(damage<DamageKind::artifact_size>(a.name));
               artifacts_.push_back(std::move(a));
             });
}

void SessionReader::read_chunks(Database& database) {
  const std::string columns =
      "seq, first_tick, ticks, inputs, records, removed, state_hash, monotonic_ns, boot_ns, utc_ns, inputs_sha256, records_sha256, "
      "removed_sha256, events_sha256, prev_sha256, sha256";
  read_table(database, "chunk", columns, findings_, [&](const Statement& row) {
    ChunkRow c = chunk_at(row, static_cast<std::int64_t>(chunks_.size()));
    const Message where = msg("table chunk, row {}", c.seq);
    if (c.ticks < 0 || c.ticks > k_chunk_ticks)
      throw Error(where, msg("{} ticks", c.ticks), msg("use an intact copy"));
    if (c.first_tick != ticks())
      throw Error(where, msg("begins at tick {} instead of {}", c.first_tick, ticks()),
                  msg("use an intact copy"));
    chunks_.push_back(std::move(c));
  });
}

void SessionReader::read_seal(Database& database) {
  const std::string columns =
      "seq, chain_sha256, final_tooth_sha256, result_sha256, chunks, ticks, events, monotonic_ns, boot_ns, utc_ns, public_key, signature";
  read_table(database, "seal", columns, findings_, [&](const Statement& row) {
    rising(row, 0, "seal");
    seal_ = Seal{row.fixed_blob<32>(1), row.fixed_blob<32>(2),  row.fixed_blob<32>(3),
                 row.integer(4),        row.integer(5),         row.integer(6),
                 clocks_at(row, 7),     row.fixed_blob<32>(10), row.fixed_blob<64>(11)};
  });
}

void SessionReader::require_readable() const {
  if (!findings_.empty())
    throw Error(path_, findings_.front().message(), msg("use an intact copy"));
  if (number("physics_version", 0) != k_physics_version)
    throw Error(path_,
                msg("was recorded under physics {}, this program has {}", fact("physics_version"),
                    k_physics_version),
                msg("use the program that recorded it"));
}

std::string SessionReader::fact(const std::string& key) const {
  const auto found = meta_.find(key);
  return found == meta_.end() ? std::string() : found->second;
}

std::int64_t SessionReader::number(const std::string& key, std::int64_t fallback) const {
  const std::string text = fact(key);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && !text.empty() ? value
                                                                                   : fallback;
}

const Artifact* SessionReader::artifact(const std::string& name) const noexcept {
  for (const auto& a : artifacts_)
    if (a.name == name) return &a;
  return nullptr;
}

SessionSetup SessionReader::setup() const {
  SessionSetup s;
  const auto text = [this](const std::string& name) {
    const Artifact* a = artifact(name);
    return a == nullptr ? std::string() : std::string(a->bytes.begin(), a->bytes.end());
  };
  s.candidate = fact("candidate");
  s.calibration = fact("calibration");
  s.source = {source_kind_of(fact(k_source_fact)).value_or(SourceKind::unnamed),
              fact(k_source_name_fact), fact(k_source_serial_fact)};
  s.scenario_toml = text("scenario.toml");
  s.rubric_toml = text("rubric.toml");
  s.force_model_toml = text("force_model.toml");
  s.servo_toml = text("servo.toml");
  s.landmarks_json = text("landmarks.json");
  if (const Artifact* tooth = artifact("start_tooth.cvt")) s.tooth = tooth->bytes;
  s.first_tip_nm = {static_cast<std::int32_t>(number("first_tip_x_nm", 0)),
                    static_cast<std::int32_t>(number("first_tip_y_nm", 0)),
                    static_cast<std::int32_t>(number("first_tip_z_nm", 0))};
  for (const auto& [key, value] : meta_)
    if (key.starts_with("note.")) s.notes.emplace_back(key.substr(5), value);
  for (const auto& a : artifacts_) {
    if (a.name.starts_with("bur_")) s.burs_toml.emplace_back(a.bytes.begin(), a.bytes.end());
    if (a.name.starts_with("attachment/")) s.attachments.emplace_back(a.name.substr(11), a.bytes);
  }
  return s;
}

Bytes SessionReader::final_tooth() const {
  const Artifact* tooth = artifact(k_final_tooth);
  return tooth == nullptr ? Bytes() : tooth->bytes;
}

Clocks SessionReader::created() const {
  return {number("created_monotonic_ns", 0), number("created_boot_ns", 0),
          number("created_utc_ns", 0)};
}

ChunkMotion SessionReader::motion(std::size_t index) const {
  const ChunkRow& c = chunks_.at(index);
  ChunkMotion m{inputs_in(c, path_), records_in(c, path_), removed_in(c, path_)};
  for (std::size_t i = 0; i < m.records.size(); ++i)
    if (m.records[i].removed != m.removed.counts[i])
      throw Error(
          msg("{}: chunk {}, tick {}", path_, c.seq, c.first_tick + static_cast<std::int64_t>(i)),
          msg("{} leaves removed by the records, {} listed", m.records[i].removed,
              m.removed.counts[i]),
          msg("the recording is damaged here: use an intact copy"));
  return m;
}

std::vector<TickInput> SessionReader::inputs() const {
  std::vector<TickInput> all;
  for (const auto& c : chunks_) {
    const auto part = inputs_in(c, path_);
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

std::vector<TickRecord> SessionReader::records() const {
  std::vector<TickRecord> all;
  for (const auto& c : chunks_) {
    const auto part = records_in(c, path_);
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

std::vector<RemovedAt> SessionReader::removed() const {
  std::vector<RemovedAt> all;
  for (const auto& c : chunks_) {
    const auto part = removed_in(c, path_);
    std::size_t at = 0;
    if (all.size() + part.leaves.size() > k_max_removed_leaves)
      throw Error(path_, msg("says that more than {} leaves were removed", k_max_removed_leaves),
                  msg("use an intact copy: no tooth has as many"));
    for (std::size_t i = 0; i < part.counts.size(); ++i)
      for (std::uint32_t k = 0; k < part.counts[i]; ++k)
        all.push_back({c.first_tick + static_cast<std::int64_t>(i), part.leaves[at++]});
  }
  return all;
}

}  // namespace cavum
