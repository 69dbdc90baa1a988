// A sound session whose rows are edited: what a database shell, a broken disk or a station with a
// key of its own can put there. The data are a byte of flags (1 = hashes, chain and signature are
// made right again; 2 and 4 leave out part of the questions, for speed) and then edits: what to do,
// which column, which row, a length of two bytes, and that many bytes. All that verification,
// grading's reader and the ledger ask of a session is asked afterwards; its physics is asked by
// replay_target and settings_target.
#include <sqlite3.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <memory>

#include "engine/session/chain.h"
#include "engine/session/chain_check.h"
#include "engine/session/clock_check.h"
#include "grading/records/filing.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {
namespace {

enum class Holds { text, number, bytes, packed };
struct Column {
  const char *table, *name;
  Holds holds;
};
constexpr std::array<Column, 22> k_columns{
    {{"chunk", "inputs", Holds::packed},       {"chunk", "records", Holds::packed},
     {"chunk", "removed", Holds::packed},      {"chunk", "ticks", Holds::number},
     {"chunk", "first_tick", Holds::number},   {"chunk", "state_hash", Holds::number},
     {"chunk", "monotonic_ns", Holds::number}, {"chunk", "boot_ns", Holds::number},
     {"chunk", "utc_ns", Holds::number},       {"event", "tick", Holds::number},
     {"event", "chunk", Holds::number},        {"event", "kind", Holds::text},
     {"event", "detail_json", Holds::text},    {"meta", "key", Holds::text},
     {"meta", "value", Holds::text},           {"artifact", "name", Holds::text},
     {"artifact", "bytes", Holds::bytes},      {"artifact", "size_bytes", Holds::number},
     {"result", "json", Holds::text},          {"seal", "ticks", Holds::number},
     {"seal", "chunks", Holds::number},        {"seal", "utc_ns", Holds::number}}};
enum Action : std::uint8_t {
  k_set,
  k_overwrite,
  k_cut,
  k_delete,
  k_repack,
  k_add_event,
  k_actions
};

/// A database in memory that may be written; its mistakes are ours to ignore: an edit that SQLite
/// refuses changes nothing.
class Copy {
 public:
  explicit Copy(const Bytes& file) {
    sqlite3* db = nullptr;
    sqlite3_open(":memory:", &db);
    db_.reset(db);
    auto* own = static_cast<unsigned char*>(sqlite3_malloc64(file.size()));
    std::copy(file.begin(), file.end(), own);
    const auto size = static_cast<sqlite3_int64>(file.size());
    sqlite3_deserialize(db, "main", own, size, size,
                        SQLITE_DESERIALIZE_FREEONCLOSE | SQLITE_DESERIALIZE_RESIZEABLE);
  }
  [[nodiscard]] Bytes file() const {
    sqlite3_int64 size = 0;
    unsigned char* bytes = sqlite3_serialize(db_.get(), "main", &size, 0);
    Bytes out(bytes, bytes + size);
    sqlite3_free(bytes);
    return out;
  }
  /// Values are bound in order: numbers, then bytes or text.
  void run(const std::string& sql, std::initializer_list<std::int64_t> numbers = {},
           std::initializer_list<Data> blobs = {}, bool text = false) {
    sqlite3_stmt* s = nullptr;
    if (sqlite3_prepare_v2(db_.get(), sql.c_str(), -1, &s, nullptr) != SQLITE_OK) return;
    int i = 0;
    for (const auto n : numbers) sqlite3_bind_int64(s, ++i, n);
    for (const auto& b : blobs) {
      const char* p = b.empty() ? "" : reinterpret_cast<const char*>(b.data());
      if (text)
        sqlite3_bind_text64(s, ++i, p, b.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
      else
        sqlite3_bind_blob64(s, ++i, p, b.size(), SQLITE_TRANSIENT);
    }
    sqlite3_step(s);
    sqlite3_finalize(s);
  }
  [[nodiscard]] Bytes value(const std::string& sql) const {
    sqlite3_stmt* s = nullptr;
    Bytes out;
    if (sqlite3_prepare_v2(db_.get(), sql.c_str(), -1, &s, nullptr) != SQLITE_OK) return out;
    if (sqlite3_step(s) == SQLITE_ROW) {
      const auto* p = static_cast<const std::uint8_t*>(sqlite3_column_blob(s, 0));
      if (p != nullptr) out.assign(p, p + sqlite3_column_bytes(s, 0));
    }
    sqlite3_finalize(s);
    return out;
  }

 private:
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> db_{nullptr, sqlite3_close_v2};
};

std::int64_t number_of(Data bytes) {
  std::int64_t n = 0;
  std::copy_n(bytes.begin(), std::min<std::size_t>(bytes.size(), sizeof n),
              reinterpret_cast<std::uint8_t*>(&n));
  if (bytes.size() == 1)
    n = static_cast<std::int8_t>(bytes[0]);  // small numbers of either sign are likelier to fit
  return n;
}

/// `payload` from its third byte on, laid over `value` at the place that its first two say.
Bytes overwritten(Bytes value, Data payload) {
  if (payload.size() < 2 || value.empty()) return value;
  std::size_t at = (payload[0] | static_cast<std::size_t>(payload[1]) << 8) % value.size();
  for (const auto b : payload.subspan(2)) {
    if (at == value.size()) break;
    value[at++] = b;
  }
  return value;
}

Bytes unpacked(const Bytes& packed) {
  constexpr std::size_t k_most = 1U << 20;
  const auto size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  Bytes raw(size <= k_most ? size : 0);
  const auto n = ZSTD_decompress(raw.data(), raw.size(), packed.data(), packed.size());
  raw.resize(ZSTD_isError(n) != 0 ? 0 : n);
  return raw;
}

Bytes packed(const Bytes& raw) {
  Bytes out(ZSTD_compressBound(raw.size()));
  out.resize(ZSTD_compress(out.data(), out.size(), raw.data(), raw.size(), 1));
  return out;
}

void edit(Copy& copy, std::uint8_t action, const Column& column, unsigned row, Data payload) {
  const std::string table = column.table, name = column.name, key = table == "meta" ? "key" : "seq";
  const std::string at = " WHERE " + key + " = (SELECT " + key + " FROM " + table +
                         " ORDER BY 1 LIMIT 1 OFFSET " + std::to_string(row) + ")";
  const auto was = [&] { return copy.value("SELECT " + name + " FROM " + table + at); };
  const auto put = [&](const Bytes& value) {
    copy.run("UPDATE " + table + " SET " + name + " = ?" + at, {}, {value},
             column.holds == Holds::text);
  };
  if (action == k_delete) return copy.run("DELETE FROM " + table + at);
  if (action == k_add_event)
    return copy.run("INSERT INTO event SELECT count(*), ?, ?, 'gap', ? FROM event",
                    {static_cast<std::int64_t>(row), 0}, {payload}, true);
  if (column.holds == Holds::number)
    return copy.run("UPDATE " + table + " SET " + name + " = ?" + at, {number_of(payload)});
  if (action == k_set)
    return put(column.holds == Holds::packed ? packed({payload.begin(), payload.end()})
                                             : Bytes(payload.begin(), payload.end()));
  if (action == k_repack && column.holds == Holds::packed)
    return put(packed(overwritten(unpacked(was()), payload)));
  Bytes value = was();
  if (action == k_cut)
    value.resize(
        std::min<std::size_t>(value.size(), static_cast<std::size_t>(number_of(payload)) & 0xffff));
  else
    value = overwritten(std::move(value), payload);
  put(value);
}

/// Hashes, chain and signature as a station would have made them of these rows.
void seal_anew(Copy& copy) {
  const Bytes file = copy.file();
  const SessionReader session(file, "recording");
  std::vector<Artifact> artifacts = session.artifacts();
  for (std::size_t i = 0; i < artifacts.size(); ++i) {
    if (artifacts[i].sha256 == sha256(artifacts[i].bytes)) continue;
    artifacts[i].sha256 = sha256(artifacts[i].bytes);
    copy.run("UPDATE artifact SET size_bytes = ?, sha256 = ? WHERE seq = " + std::to_string(i),
             {static_cast<std::int64_t>(artifacts[i].bytes.size())}, {artifacts[i].sha256});
  }
  Sha256 chain = genesis_hash(session.meta(), artifacts);
  for (ChunkRow c : session.chunks()) {
    std::vector<EventRow> events;
    for (const auto& e : session.event_rows())
      if (e.chunk == c.seq) events.push_back(e);
    c.inputs_sha256 = sha256(c.inputs);
    c.records_sha256 = sha256(c.records);
    c.removed_sha256 = sha256(c.removed);
    c.events_sha256 = events_hash(events);
    c.prev_sha256 = chain;
    chain = c.sha256 = chunk_hash(c);
    copy.run(
        "UPDATE chunk SET inputs_sha256 = ?, records_sha256 = ?, removed_sha256 = ?, events_sha256 = ?, prev_sha256 = ?, sha256 = ? WHERE seq = " +
            std::to_string(c.seq),
        {},
        {c.inputs_sha256, c.records_sha256, c.removed_sha256, c.events_sha256, c.prev_sha256,
         c.sha256});
  }
  if (!session.seal()) return;
  Seal seal = *session.seal();
  seal.chain_sha256 = chain;
  seal.final_tooth_sha256 = sha256(session.final_tooth());
  seal.result_sha256 = sha256(session.result_json());
  seal.chunks = static_cast<std::int64_t>(session.chunks().size());
  seal.ticks = session.ticks();
  seal.events = static_cast<std::int64_t>(session.event_rows().size());
  seal.public_key = station_key().public_key;
  seal.signature = station_key().sign(seal_message(seal));
  copy.run(
      "UPDATE seal SET chunks = ?, ticks = ?, events = ?, chain_sha256 = ?, final_tooth_sha256 = ?, result_sha256 = ?, public_key = ?, signature = ?",
      {seal.chunks, seal.ticks, seal.events},
      {seal.chain_sha256, seal.final_tooth_sha256, seal.result_sha256, seal.public_key,
       seal.signature});
}

void question(const SessionReader& session, int what) {
  if (what != 1) static_cast<void>(check_chain(session));
  if (what != 1) static_cast<void>(check_clocks(session));
  if (what != 1 && what != 3)
    static_cast<void>(records::check_claims(school_ledger(), session, {}));
  static_cast<void>(session.setup());
  if (what > 1) return;
  read_all_ticks(session);
}

}  // namespace

void fuzz_recording(Data data) {
  if (data.empty()) return;
  Copy copy(small_session());
  const bool sealed = (data[0] & 1) != 0;
  const int what = data[0] >> 1 & 3;
  constexpr std::size_t k_head = 5;
  for (data = data.subspan(1); data.size() >= k_head;) {
    const std::size_t length = std::min<std::size_t>(
        data[3] | static_cast<std::size_t>(data[4]) << 8, data.size() - k_head);
    edit(copy, data[0] % k_actions, k_columns[data[1] % k_columns.size()], data[2] % 16U,
         data.subspan(k_head, length));
    data = data.subspan(k_head + length);
  }
  try {
    if (sealed) seal_anew(copy);
    question(SessionReader(copy.file(), "recording"), what);
  } catch (const Error&) {
  }
}

std::vector<Bytes> recording_seeds() {
  std::vector<Bytes> seeds{{0}, {1}};
  const auto edit_of = [](std::uint8_t action, std::size_t column, std::uint8_t row,
                          const Bytes& payload) {
    Bytes b{1,
            action,
            static_cast<std::uint8_t>(column),
            row,
            static_cast<std::uint8_t>(payload.size()),
            static_cast<std::uint8_t>(payload.size() >> 8)};
    b.insert(b.end(), payload.begin(), payload.end());
    return b;
  };
  for (std::size_t column = 0; column < k_columns.size(); ++column) {
    seeds.push_back(edit_of(k_set, column, 0, {1, 2, 3}));
    seeds.push_back(edit_of(k_overwrite, column, 1, {7, 0, 255, 255}));
    seeds.push_back(edit_of(k_cut, column, 2, {9}));
    seeds.push_back(edit_of(k_delete, column, 0, {}));
    if (k_columns[column].holds == Holds::packed)
      for (std::uint8_t row = 0; row < 3; ++row)
        seeds.push_back(edit_of(k_repack, column, row, {100, 0, 255, 127, 0, 128}));
  }
  for (
      const char* text :
      {R"({"boot_id":7,"source":{"device":1,"operator":2},"resumed_utc_ns":"x","gap_utc_s":1e300})",
       R"({"source":{"operator":"expert"}})"})
    seeds.push_back(edit_of(k_add_event, 0, 3, bytes_of(text)));
  seeds.push_back(edit_of(k_set, 18, 0, bytes_of(small_result())));
  seeds.push_back(edit_of(k_set, 14, 15, bytes_of(small_ticket())));
  for (const char* file : {"burs/round-1.0.toml", "materials/paper.toml"})
    for (std::uint8_t row = 0; row < 6; ++row)
      seeds.push_back(edit_of(k_set, 16, row, bytes_of(data_text(file))));
  return seeds;
}

}  // namespace cavum::fuzz
