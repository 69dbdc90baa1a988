// The other end of the servo's stream: a thread that takes every tick, lets the exam's runner see
// it, and records it. What went wrong in the servo becomes events here: overruns, gaps, faults, the
// reason of the end.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "engine/physics/servo/tick_stream.h"
#include "engine/session/recorder.h"

namespace cavum {

struct WriterReport {
  std::int64_t ticks = 0;         ///< taken from the stream
  std::int64_t most_waiting = 0;  ///< ticks that were waiting at the worst moment
  Message error;        ///< first error of recorder or watch; empty = everything is on disk
  DiskRefusal refusal;  ///< where it was the disk's
};

/// Events it writes: Overruns and ServoGap each second, StylusSilent and StylusBack, PedalLost and
/// PedalBack, ServoStopped.
class SessionWriter {
 public:
  /// Sees every tick on the writer's thread before it is recorded; may add events to the recorder.
  /// Returns whether the writer shall record the tick: an exam does so itself.
  using Watch = std::function<bool(const ServoTick& tick, std::span<const RemovedLeaf> removed)>;

  /// Stream and recorder must outlive it; the recorder belongs to its thread until `finish`.
  SessionWriter(TickStream& stream, Recorder& recorder, double tick_s, Watch watch = {});
  /// Waits for the stream's end.
  ~SessionWriter();
  SessionWriter(const SessionWriter&) = delete;
  SessionWriter& operator=(const SessionWriter&) = delete;

  void start();
  /// Waits until the stream is closed and everything in it is written. The session stays open:
  /// close it, or resume later.
  const WriterReport& finish();

 private:
  void run() noexcept;
  void take(const ServoTick& tick);
  void note_changes(const ServoTick& tick);
  void note_counts(std::int64_t tick);
  template <class Action>
  void guarded(const Action& action) noexcept;

  TickStream& stream_;
  Recorder& recorder_;
  const std::int64_t period_ns_;
  Watch watch_;
  std::thread thread_;
  std::vector<RemovedLeaf> removed_;
  std::uint16_t last_flags_ = k_pedal_fresh;
  bool was_silent_ = false;
  std::int64_t overruns_ = 0, worst_late_ns_ = 0;
  std::int64_t gap_periods_ = 0, gaps_ = 0, first_gap_tick_ = 0;
  std::int64_t counted_since_ = 0;  ///< tick
  WriterReport report_;
};

}  // namespace cavum
