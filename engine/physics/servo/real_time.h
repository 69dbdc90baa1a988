// The servo in real time: a thread that takes one step a period around the same `step` as
// everything else. Nothing in it blocks, allocates or logs. A tick that comes late is made up for,
// counted and handed on with its lateness; whatever goes wrong ends with zero force, and every step
// taken is in the stream.
#pragma once

#include <atomic>
#include <memory>

#include "engine/base/message.h"
#include "engine/physics/servo/lateness.h"
#include "engine/physics/servo/scheduling.h"
#include "engine/physics/servo/servo.h"
#include "engine/physics/servo/servo_device.h"
#include "engine/physics/servo/tick_stream.h"

namespace cavum {

struct RealTimeOptions {
  bool ask_for_fifo = true;    ///< SCHED_FIFO, when the system allows it
  bool ask_for_memory = true;  ///< mlockall, when the system allows it
  int priority = 70;           ///< of SCHED_FIFO, 1..98; the guard runs one above
  std::int64_t max_ticks = 0;  ///< stops by itself after so many; 0 = never
  int most_made_up = 100;      ///< ticks made up for at once, within half of the watchdog's time;
                               ///< periods beyond are skipped, and counted
};

/// What happened. Nothing is hidden: periods = ticks + skipped_full + skipped_late.
struct RealTimeReport {
  std::int64_t ticks = 0;     ///< steps taken
  std::int64_t overruns = 0;  ///< of them, started more than a period late
  std::int64_t made_up = 0;   ///< of them, taken without a reading because their time had passed
  std::int64_t skipped_late =
      0;  ///< periods given up after a long pause, or because steps take longer than a period
  std::int64_t skipped_full =
      0;  ///< periods without a step because nobody emptied the stream: zero force meanwhile
  std::int64_t guard_cuts = 0;  ///< times the guard took the force away because the loop hung
  Lateness lateness;            ///< start of the ticks
  Lateness work;                ///< duration of reading, step and sending, in the same bins
  SystemGrant fifo, memory;     ///< SCHED_FIFO; all pages kept in memory
  ServoStop ended;
  Message failure;  ///< what the device threw, to be told
};

/// "the device failed when it was read"
[[nodiscard]] Message in_words(const ServoStop& stop);

/// Late ticks: their input repeats the last one without k_stylus_fresh (and, past the watchdog's
/// time, without k_pedal_fresh), so the recorded time is real time and the watchdog sees the
/// silence. When `read` or `send_force` hangs, a guard thread cuts the force within twice the
/// watchdog's time, 10 ms.
class RealTimeServo {
 public:
  /// Model, device and stream must outlive it; `state` belongs to its thread until `join`.
  /// `before_first` is what a made-up first tick would repeat.
  RealTimeServo(const ServoModel& model, ServoState& state, ServoDevice& device, TickStream& stream,
                const TickInput& before_first, const RealTimeOptions& options = {});
  /// Stops and joins.
  ~RealTimeServo();
  RealTimeServo(const RealTimeServo&) = delete;
  RealTimeServo& operator=(const RealTimeServo&) = delete;

  void start();  ///< throws Error when the system gives no threads, with the stream closed; or when
                 ///< it was started already
  void ask_to_stop() noexcept;
  [[nodiscard]] bool running() const noexcept;
  /// Waits for the end; the stream is closed by then, and zero force was sent. May be called again.
  const RealTimeReport& join();

 private:
  struct Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace cavum
