// Writes a session while the exam runs: every second of motion is one transaction, chained to the
// one before and synced to disk. It waits for the disk (typically 1 ms, now and then 10): call it
// from the writer thread, never from the servo.
#pragma once

#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/session/chunk_codec.h"
#include "engine/session/session.h"
#include "engine/session/sqlite.h"
#include "engine/session/station_key.h"

namespace cavum {

class Recorder {
 public:
  /// A new session file holding the setup. Throws Error when `path` exists or cannot be written,
  /// when the setup lacks tooth, burs, force model or servo settings or names no source of motion,
  /// or when the station has no usable key.
  [[nodiscard]] static Recorder create(const std::string& path, const SessionSetup& setup,
                                       const ReadClocks& clocks = read_clocks);

  Recorder(Recorder&&) = default;
  Recorder& operator=(Recorder&&) = delete;
  /// Writes what is pending, if it can. A session that was not closed can be resumed.
  ~Recorder();

  /// Takes one tick: its input, what the servo made of it, the leaves it removed (`record.removed`
  /// of them) and state_hash(ServoState) after it. Each full second is written at once. When that
  /// fails (disk full …) it throws Error, and the tick is kept nevertheless: make room and go on
  /// with the next tick, or call `flush`. Nothing is lost while the process lives; what is pending
  /// is written with the next full second.
  void append(const TickInput& input, const TickRecord& record,
              std::span<const RemovedLeaf> removed, std::uint64_t state_hash);

  /// Notes an event; it is written with the running second.
  void add_event(std::int64_t tick, Event event);

  /// Writes everything pending, the running second included. Throws Error like `append`; call again
  /// after making room.
  void flush();

  /// Writes the rest, the tooth as it is now (save_tooth) and the result, signs, and leaves a
  /// single file. Throws Error when it cannot; nothing is lost, call again. After success only
  /// `ticks` may be called.
  void close(std::span<const std::uint8_t> final_tooth, const std::string& result_json);

  /// Goes on in a new file at another place, for a disk that stays full: all that was written so
  /// far is copied there, RecordingMoved is noted, what waits is written, and what comes goes
  /// there. The first file stays as it is: a session that was never closed. Throws Error when
  /// `path` exists, or cannot be written either; before the copy is whole nothing has changed then,
  /// afterwards what waits goes on waiting for the new place.
  void move_to(const std::string& path, const DiskRefusal& why);

  /// Where it records.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// What is on disk, as the bytes of a single file; for reading without a place to copy it to.
  [[nodiscard]] Bytes image() { return database_->image(); }

  [[nodiscard]] std::int64_t ticks() const noexcept { return ticks_; }
  [[nodiscard]] std::int64_t ticks_on_disk() const noexcept { return ticks_on_disk_; }
  /// Longest time one second of motion took to be written, s.
  [[nodiscard]] double slowest_write_s() const noexcept { return slowest_write_s_; }

 private:
  friend class Resumption;
  struct Pending {
    std::vector<TickInput> inputs;
    std::vector<TickRecord> records;
    RemovedTicks removed;
    std::vector<TimedEvent> events;
    std::uint64_t state_hash = 0;
    std::optional<Clocks> complete;  ///< when its last tick came
  };
  Recorder(std::string path, SigningKey key, ReadClocks clocks);
  void open_for_recording();
  void require_database();
  void require_open() const;
  void write_pending();
  void write_chunk(const Pending& pending);
  void write_seal(std::span<const std::uint8_t> final_tooth, const std::string& result_json);

  std::string path_;
  SigningKey key_;
  ReadClocks clocks_;
  std::optional<Database> database_;
  std::optional<Statement> insert_chunk_, insert_event_;
  std::deque<Pending> pending_;  ///< the last one is being filled
  Sha256 chain_{};               ///< of what is on disk
  std::int64_t next_chunk_ = 0, next_event_ = 0, next_artifact_ = 0;
  std::int64_t ticks_ = 0, ticks_on_disk_ = 0;
  double slowest_write_s_ = 0;
  bool sealed_ = false;
};

/// Makes an open database a single file again: log applied and removed. Throws DatabaseError.
void make_single_file(Database& database);

}  // namespace cavum
