#include "engine/session/recorder.h"

#include <fmt/core.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/base/file_error.h"
#include "engine/base/json_reader.h"
#include "engine/base/version.h"
#include "engine/base/write_file.h"
#include "engine/physics/servo/servo.h"
#include "engine/session/chain.h"
#include "engine/session/schema.h"
#include "engine/session/session_error.h"

namespace cavum {
namespace {

constexpr char k_insert_chunk[] =
    "INSERT INTO chunk VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";
constexpr char k_insert_event[] = "INSERT INTO event VALUES (?, ?, ?, ?, ?)";

std::map<std::string, std::string> meta_of(const SessionSetup& setup, const Clocks& now) {
  const std::string tick =
      fmt::format("{:.17g}", parse_servo_config(setup.servo_toml, "servo.toml").tick_s);
  std::map<std::string, std::string> meta{
      {"format", std::to_string(k_session_format)},
      {"engine_version", version()},
      {"physics_version", std::to_string(k_physics_version)},
      {"candidate", setup.candidate},
      {"calibration", setup.calibration},
      {k_source_fact, text_of(setup.source.kind)},
      {k_source_name_fact, setup.source.name},
      {k_source_serial_fact, setup.source.serial},
      {"tick_s", tick},
      {"first_tip_x_nm", std::to_string(setup.first_tip_nm[0])},
      {"first_tip_y_nm", std::to_string(setup.first_tip_nm[1])},
      {"first_tip_z_nm", std::to_string(setup.first_tip_nm[2])},
      {"created_utc", utc_text(now.utc_ns)},
      {"created_utc_ns", std::to_string(now.utc_ns)},
      {"created_boot_ns", std::to_string(now.boot_ns)},
      {"created_monotonic_ns", std::to_string(now.monotonic_ns)},
      {"boot_id", boot_id()},
  };
  for (const auto& [key, value] : setup.notes) meta["note." + key] = value;
  return meta;
}

void insert_artifact(Database& database, std::int64_t seq, const Artifact& a) {
  Statement s = database.prepare("INSERT INTO artifact VALUES (?, ?, ?, ?, ?)");
  s.bind(1, seq)
      .bind(2, a.name)
      .bind(3, a.sha256)
      .bind(4, static_cast<std::int64_t>(a.bytes.size()))
      .bind(5, a.bytes)
      .run();
}

void write_setup(const std::string& path, const std::map<std::string, std::string>& meta,
                 const std::vector<Artifact>& artifacts) {
  Database database = Database::open(path, true);
  // Small pages: a chunk fills its last page by half on average.
  database.run("PRAGMA page_size = 1024; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON");
  database.run(fmt::format("PRAGMA application_id = {}", k_session_application_id).c_str());
  database.run(fmt::format("PRAGMA user_version = {}", k_session_format).c_str());
  Transaction transaction(database);
  for (const char* sql : k_session_schema) database.run(sql);
  {
    Statement insert = database.prepare("INSERT INTO meta VALUES (?, ?)");
    for (const auto& [key, value] : meta) insert.bind(1, key).bind(2, value).run();
  }
  for (std::size_t i = 0; i < artifacts.size(); ++i)
    insert_artifact(database, static_cast<std::int64_t>(i), artifacts[i]);
  transaction.commit();
}

/// A file never appears under its name before its setup is complete, and never replaces another.
void put_session_in_place(const std::string& made, const std::string& path) {
  bool placed = false;
  try {
    placed = put_in_place(made, path);
  } catch (const Error& refusal) {
    ::unlink(made.c_str());
    throw DatabaseError(refusal,
                        DiskFault::input_output);  // the disk's, as any while recording: an exam
                                                   // then begins at its second place
  }
  if (placed) return;
  ::unlink(made.c_str());
  throw Error(FileError::exists, Name{path},
              msg("exists already: another exam began to record into it"),
              msg("choose another name; an existing session is never overwritten"));
}

constexpr char k_being_made[] = ".new-";

/// A process that is killed while it begins a session leaves NAME.new-PID (and its journal) behind.
/// Those of this name go when the next session of the name is begun, unless their process still
/// runs. What cannot be removed stays: it harms nothing.
void remove_leftovers(const std::string& path) {
  const std::filesystem::path file(path);
  const std::string begin = file.filename().string() + k_being_made;
  std::error_code none;
  std::vector<std::filesystem::path> gone;
  for (const auto& entry : std::filesystem::directory_iterator(
           file.has_parent_path() ? file.parent_path() : ".", none)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(begin)) continue;
    int pid = 0;
    const char* end = name.data() + name.size();
    const auto number = std::from_chars(name.data() + begin.size(), end, pid);
    const std::string_view rest(number.ptr, static_cast<std::size_t>(end - number.ptr));
    if (number.ec != std::errc() || pid <= 0 || (!rest.empty() && rest != "-journal")) continue;
    if (::kill(pid, 0) != 0 && errno == ESRCH) gone.push_back(entry.path());
  }
  for (const auto& leftover : gone) std::filesystem::remove(leftover, none);
}

/// No session, and no log of one, lies at `path`.
void require_free(const std::string& path) {
  for (const char* suffix : {"", "-wal", "-journal"})
    if (struct stat info{}; ::lstat((path + suffix).c_str(), &info) == 0)
      throw Error(FileError::exists, Name{path + suffix}, msg("exists already"),
                  msg("choose another name; an existing session is never overwritten"));
}

}  // namespace

void make_single_file(Database& database) {
  database.run("PRAGMA wal_checkpoint(TRUNCATE)");
  database.run("PRAGMA journal_mode = DELETE");
}

Recorder::Recorder(std::string path, SigningKey key, ReadClocks clocks)
    : path_(std::move(path)), key_(key), clocks_(std::move(clocks)), pending_(1) {}

Recorder Recorder::create(const std::string& path, const SessionSetup& setup,
                          const ReadClocks& clocks) {
  const auto need = [&](bool there, const Message& what) {
    if (!there) throw Error(FileError::missing, Name{path}, what, msg("give it in the setup"));
  };
  need(!setup.tooth.empty(), msg("a session needs a tooth"));
  need(!setup.burs_toml.empty() && setup.burs_toml.size() <= 255,
       msg("a session needs between 1 and 255 burs"));
  need(!setup.force_model_toml.empty(), msg("a session needs a force model"));
  need(!setup.servo_toml.empty(), msg("a session needs servo settings"));
  need(!setup.candidate.empty(), msg("a session needs the candidate's pseudonym"));
  need(setup.source.kind != SourceKind::unnamed, msg("a session needs what moves the stylus"));
  std::set<std::string> attached;
  for (const auto& [name, bytes] : setup.attachments)
    if (!attached.insert(name).second)
      throw Error(path, msg("two attachments are named '{}'", name), msg("give each its own name"));
  require_free(path);

  Recorder recorder(path, load_station_key(station_key_path()), clocks);
  const auto artifacts = artifacts_of(setup);
  auto meta = meta_of(setup, clocks());
  meta[k_station_fact] = to_hex(recorder.key_.public_key);
  meta[k_begun_fact] = to_hex(recorder.key_.sign(begin_message(meta, artifacts)));
  remove_leftovers(path);
  const std::string made =
      path + k_being_made +
      std::to_string(
          ::getpid());  // of this process alone: two exams may be begun under one name at once
  ::unlink(made.c_str());
  ::unlink((made + "-journal").c_str());
  try {
    write_setup(made, meta, artifacts);
  } catch (const Error&) {
    ::unlink(made.c_str());
    ::unlink((made + "-journal").c_str());
    throw;
  }
  put_session_in_place(made, path);
  recorder.chain_ = genesis_hash(meta, artifacts);
  recorder.next_artifact_ = static_cast<std::int64_t>(artifacts.size());
  try {
    recorder.open_for_recording();
  } catch (const Error&) {  // the disk took the setup and nothing more: no session is left behind
                            // that nobody began
    recorder.database_.reset();
    for (const char* end : {"", "-wal", "-shm", "-journal"}) ::unlink((path + end).c_str());
    throw;
  }
  return recorder;
}

void Recorder::open_for_recording() {
  database_ = Database::open(path_, false);
  // exclusive: no second recorder, and the index of the log stays in memory
  database_->run(
      "PRAGMA locking_mode = EXCLUSIVE; PRAGMA foreign_keys = ON; PRAGMA synchronous = FULL; PRAGMA wal_autocheckpoint = 4000");
  database_->run("PRAGMA cache_size = -512");  // KiB: what is written is not read again, and an
                                               // exam's memory stays the same for its whole length
  if (database_->text("PRAGMA journal_mode = WAL") != "wal")
    throw Error(path_, msg("the file system does not allow a write-ahead log"),
                msg("record to a local disk"));
  insert_chunk_ = database_->prepare(k_insert_chunk);
  insert_event_ = database_->prepare(k_insert_event);
}

Recorder::~Recorder() {
  try {
    if (database_ && !sealed_ && !pending_.empty())
      flush();  // a recorder that was moved from has nothing, not even the running second
  } catch (const std::exception&) {  // everything written so far stands; the rest is lost with the
                                     // process
  }
}

/// A move that could not open its new file may have left none.
void Recorder::require_database() {
  if (sealed_ && database_ && database_->is_open()) return;
  if (!database_ || !database_->is_open() || !insert_chunk_ || !insert_event_) open_for_recording();
}

void Recorder::require_open() const {
  if (sealed_)
    throw Error(SessionError::closed, Name{path_}, msg("the session is closed"),
                msg("record into a new one"));
}

void Recorder::append(const TickInput& input, const TickRecord& record,
                      std::span<const RemovedLeaf> removed, std::uint64_t state_hash) {
  require_open();
  if (record.removed != removed.size())
    throw Error(FileError::inconsistent, Name{path_},
                msg("tick {} lists {} removed leaves, its record says {}", ticks_, removed.size(),
                    record.removed),
                msg("hand over state.removed of the same tick"));
  Pending& now = pending_.back();
  now.inputs.push_back(input);
  now.records.push_back(record);
  now.removed.counts.push_back(record.removed);
  now.removed.leaves.insert(now.removed.leaves.end(), removed.begin(), removed.end());
  now.state_hash = state_hash;
  ++ticks_;
  if (static_cast<std::int64_t>(now.inputs.size()) < k_chunk_ticks &&
      now.removed.leaves.size() < k_chunk_leaves)
    return;
  now.complete = clocks_();
  pending_.emplace_back();
  pending_.back().state_hash = state_hash;
  write_pending();
}

void Recorder::add_event(std::int64_t tick, Event event) {
  require_open();
  pending_.back().events.push_back({tick, std::move(event)});
}

void Recorder::flush() {
  Pending& now = pending_.back();
  if (!now.inputs.empty() || !now.events.empty()) {
    const auto state_hash = now.state_hash;
    now.complete = clocks_();
    pending_.emplace_back();
    pending_.back().state_hash = state_hash;
  }
  write_pending();
}

void Recorder::move_to(const std::string& path, const DiskRefusal& why) {
  if (database_ && !database_->is_open() && sealed_)
    throw Error(SessionError::closed, Name{path_}, msg("the session is closed"),
                msg("copy its file"));
  require_database();
  require_free(path);
  const std::string made = path + k_being_made + std::to_string(::getpid());
  remove_leftovers(path);
  ::unlink(made.c_str());
  ::unlink((made + "-journal").c_str());
  try {
    Database copy = Database::open(made, true);
    copy.run("PRAGMA synchronous = FULL");
    database_->copy_to(copy);
  } catch (const Error&) {
    for (const char* end : {"", "-journal", "-wal", "-shm"}) ::unlink((made + end).c_str());
    throw;
  }
  for (const char* end : {"-wal", "-shm"}) ::unlink((made + end).c_str());
  put_session_in_place(made, path);
  RecordingMoved moved{std::filesystem::path(path_).filename().string(), ticks_on_disk_, why};
  insert_chunk_.reset();
  insert_event_.reset();
  database_->close();
  path_ = path;
  open_for_recording();
  if (sealed_) return;
  pending_.back().events.push_back({ticks_, std::move(moved)});
  flush();
}

void Recorder::write_pending() {
  require_database();
  while (pending_.size() > 1) {
    write_chunk(pending_.front());
    pending_.pop_front();
  }
}

void Recorder::write_chunk(const Pending& pending) {
  const auto start = std::chrono::steady_clock::now();
  ChunkRow c;
  c.seq = next_chunk_;
  c.first_tick = ticks_on_disk_;
  c.ticks = static_cast<std::int64_t>(pending.inputs.size());
  c.inputs = pack_inputs(pending.inputs);
  c.records = pack_records(pending.records);
  c.removed = pack_removed(pending.removed);
  c.state_hash = pending.state_hash;
  c.clocks = *pending.complete;
  c.inputs_sha256 = sha256(c.inputs);
  c.records_sha256 = sha256(c.records);
  c.removed_sha256 = sha256(c.removed);
  std::vector<EventRow> events;
  for (const auto& e : pending.events)
    events.push_back({e, next_event_ + static_cast<std::int64_t>(events.size()), c.seq});
  c.events_sha256 = events_hash(events);
  c.prev_sha256 = chain_;
  c.sha256 = chunk_hash(c);

  Transaction transaction(*database_);
  insert_chunk_->bind(1, c.seq)
      .bind(2, c.first_tick)
      .bind(3, c.ticks)
      .bind(4, c.inputs)
      .bind(5, c.records)
      .bind(6, c.removed);
  insert_chunk_->bind(7, static_cast<std::int64_t>(c.state_hash))
      .bind(8, c.clocks.monotonic_ns)
      .bind(9, c.clocks.boot_ns)
      .bind(10, c.clocks.utc_ns);
  insert_chunk_->bind(11, c.inputs_sha256)
      .bind(12, c.records_sha256)
      .bind(13, c.removed_sha256)
      .bind(14, c.events_sha256);
  insert_chunk_->bind(15, c.prev_sha256).bind(16, c.sha256).run();
  for (const auto& e : events) {
    const EventText text = encode(e.event);
    insert_event_->bind(1, e.seq)
        .bind(2, e.tick)
        .bind(3, e.chunk)
        .bind(4, text.kind)
        .bind(5, text.detail_json)
        .run();
  }
  transaction.commit();

  chain_ = c.sha256;
  ++next_chunk_;
  next_event_ += static_cast<std::int64_t>(events.size());
  ticks_on_disk_ += c.ticks;
  slowest_write_s_ =
      std::max(slowest_write_s_,
               std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

void Recorder::write_seal(std::span<const std::uint8_t> final_tooth,
                          const std::string& result_json) {
  flush();
  Seal seal;
  seal.chain_sha256 = chain_;
  seal.final_tooth_sha256 = sha256(final_tooth);
  seal.result_sha256 = sha256(result_json);
  seal.chunks = next_chunk_;
  seal.ticks = ticks_on_disk_;
  seal.events = next_event_;
  seal.clocks = clocks_();
  seal.public_key = key_.public_key;
  seal.signature = key_.sign(seal_message(seal));
  Transaction transaction(*database_);
  insert_artifact(
      *database_, next_artifact_,
      {k_final_tooth, seal.final_tooth_sha256, Bytes(final_tooth.begin(), final_tooth.end())});
  Statement result = database_->prepare("INSERT INTO result VALUES (0, ?)");
  result.bind(1, result_json).run();
  Statement s = database_->prepare("INSERT INTO seal VALUES (0, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  s.bind(1, seal.chain_sha256)
      .bind(2, seal.final_tooth_sha256)
      .bind(3, seal.result_sha256)
      .bind(4, seal.chunks)
      .bind(5, seal.ticks);
  s.bind(6, seal.events)
      .bind(7, seal.clocks.monotonic_ns)
      .bind(8, seal.clocks.boot_ns)
      .bind(9, seal.clocks.utc_ns);
  s.bind(10, seal.public_key).bind(11, seal.signature).run();
  transaction.commit();
  sealed_ = true;
}

void Recorder::close(std::span<const std::uint8_t> final_tooth, const std::string& result_json) {
  if (final_tooth.empty())
    throw Error(FileError::missing, Name{path_}, msg("the final tooth is missing"),
                msg("give save_tooth of the drilled tooth"));
  if (!is_json(result_json, k_json_part))
    throw Error(path_, msg("the result is not JSON"), msg("give one JSON value"));
  require_database();
  if (!sealed_) write_seal(final_tooth, result_json);
  insert_chunk_.reset();
  insert_event_.reset();
  make_single_file(*database_);
  database_->close();
}

}  // namespace cavum
