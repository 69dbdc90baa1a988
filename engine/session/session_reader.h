// Reads a session file without changing a byte of it, however damaged it is. What cannot be read
// becomes a finding in words; what can be read is there. Whether it is true is for verify.h to say.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/chunk_codec.h"
#include "engine/session/damage.h"
#include "engine/session/session.h"

namespace cavum {

class Database;

/// The most leaves that a recording says were removed: 1000 mm3 at a leaf of 0.05 mm have 8
/// million, each removed once.
inline constexpr std::size_t k_max_removed_leaves = 16'000'000;

/// A leaf and the tick in which it was removed.
struct RemovedAt {
  std::int64_t tick = 0;
  RemovedLeaf leaf;
};

class SessionReader {
 public:
  /// Reads a closed session, one that was killed (its log beside it), or one being recorded. Throws
  /// Error only when the file cannot be a session at all: missing, not SQLite, or another program's
  /// database.
  explicit SessionReader(const std::string& path);
  /// The same from a file's bytes, which have no log beside them; `name` stands for the file in
  /// errors.
  SessionReader(Bytes file, const std::string& name);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// Damage found while reading, each naming its table and row; empty for a sound file.
  [[nodiscard]] const Damages& findings() const noexcept { return findings_; }
  /// Throws Error with the first finding, or of another physics, for callers that can do nothing
  /// with such a session.
  void require_readable() const;

  [[nodiscard]] bool closed() const noexcept { return seal_.has_value(); }
  [[nodiscard]] const std::optional<Seal>& seal() const noexcept { return seal_; }
  [[nodiscard]] const std::map<std::string, std::string>& meta() const noexcept { return meta_; }
  /// A fact of `meta`; empty when there is none.
  [[nodiscard]] std::string fact(const std::string& key) const;
  /// A whole number of `meta`; `fallback` when missing or no number.
  [[nodiscard]] std::int64_t number(const std::string& key, std::int64_t fallback) const;
  [[nodiscard]] const std::vector<Artifact>& artifacts() const noexcept { return artifacts_; }
  [[nodiscard]] const Artifact* artifact(const std::string& name) const noexcept;
  [[nodiscard]] SessionSetup setup() const;
  /// Compact tooth file after the last tick; empty when not closed.
  [[nodiscard]] Bytes final_tooth() const;
  /// Result of the exam, JSON text; empty when not closed.
  [[nodiscard]] const std::string& result_json() const noexcept { return result_json_; }
  /// Clocks when the file was made.
  [[nodiscard]] Clocks created() const;

  /// Rows as stored, by seq.
  [[nodiscard]] const std::vector<ChunkRow>& chunks() const noexcept { return chunks_; }
  [[nodiscard]] const std::vector<EventRow>& event_rows() const noexcept { return events_; }
  /// Ticks recorded, from the numbers of the last chunk.
  [[nodiscard]] std::int64_t ticks() const noexcept {
    return chunks_.empty() ? 0 : chunks_.back().first_tick + chunks_.back().ticks;
  }
  [[nodiscard]] std::vector<TimedEvent> events() const { return {events_.begin(), events_.end()}; }

  /// Motion of chunks()[index]. Throws Error(path: chunk N, …) when it does not unpack.
  [[nodiscard]] ChunkMotion motion(std::size_t index) const;
  /// The whole exam, tick by tick (about 90 bytes each). Throw Error when any chunk does not
  /// unpack.
  [[nodiscard]] std::vector<TickInput> inputs() const;
  [[nodiscard]] std::vector<TickRecord> records() const;
  [[nodiscard]] std::vector<RemovedAt> removed() const;

 private:
  void read(Bytes image);
  void read_artifacts(Database& database);
  void read_chunks(Database& database);
  void read_seal(Database& database);

  std::string path_;
  Damages findings_;
  std::map<std::string, std::string> meta_;
  std::vector<Artifact> artifacts_;
  std::vector<ChunkRow> chunks_;
  std::vector<EventRow> events_;
  std::string result_json_;
  std::optional<Seal> seal_;
};

}  // namespace cavum
