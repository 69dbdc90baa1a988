// From the servo thread to the thread that writes: every tick with the leaves it removed, in order,
// none lost. The servo asks for room before it takes a step, so a step that was taken can always be
// handed over.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/spsc_ring.h"
#include "engine/physics/servo/tick.h"

namespace cavum {

/// One tick as the servo thread hands it over.
struct ServoTick {
  std::int64_t tick = 0;  ///< ServoState::tick before the step: the first one is 0
  TickInput input;
  TickOutput output;
  std::uint64_t state_hash = 0;
  std::int64_t late_ns = 0;          ///< it started so long after its time
  std::int64_t skipped_periods = 0;  ///< periods that passed without a tick just before this one
};

/// Why nothing follows: it was asked for, as many ticks as wanted were taken, or the device failed.
enum class ServoEnd : std::uint8_t { asked, ticks, device_failed };
inline constexpr std::array k_servo_end_names{"asked", "ticks", "device_failed"};
[[nodiscard]] constexpr auto names_of(ServoEnd) { return k_servo_end_names; }
/// What of the device failed: it threw when it was read, or when a force was sent to it; it did not
/// take the last, zero force; or the system gave the servo no threads.
enum class ServoFault : std::uint8_t { none, reading, sending, zero_force, threads };
inline constexpr std::array k_servo_fault_names{"none", "reading", "sending", "zero_force",
                                                "threads"};
static_assert(k_servo_fault_names.size() == static_cast<std::size_t>(ServoFault::threads) + 1);
[[nodiscard]] constexpr auto names_of(ServoFault) { return k_servo_fault_names; }
struct ServoStop {
  ServoEnd why = ServoEnd::asked;
  ServoFault fault = ServoFault::none;
  std::int32_t error = 0;  ///< errno; 0: the system gave none
  friend bool operator==(const ServoStop&, const ServoStop&) = default;
};

class TickStream {
 public:
  /// Defaults: half a minute at 1 kHz, 11 MB.
  explicit TickStream(std::size_t ticks = 1u << 15, std::size_t leaves = 1u << 18)
      : ticks_(ticks), leaves_(leaves) {}

  // ---- servo thread ----
  /// Is there room for one more tick that removes up to `leaves`?
  [[nodiscard]] bool has_room(std::size_t leaves) const noexcept {
    return ticks_.room() > 0 && leaves_.room() >= leaves;
  }
  /// `tick.output.removed_count` leaves. Returns false without room: then nothing was taken.
  bool push(const ServoTick& tick, std::span<const RemovedLeaf> removed) noexcept {
    return ticks_.room() > 0 && leaves_.push(removed) &&
           ticks_.push(tick);  // leaves first: whoever sees the tick finds them
  }
  /// Nothing follows.
  void close(const ServoStop& stop) noexcept {
    stop_ = stop;
    closed_.store(true, std::memory_order_release);
  }

  // ---- writing thread ----
  [[nodiscard]] bool pop(ServoTick& tick, std::vector<RemovedLeaf>& removed) {
    if (!ticks_.pop(tick)) return false;
    removed.resize(tick.output.removed_count);
    return leaves_.pop(std::span(removed));
  }
  [[nodiscard]] std::size_t waiting() const noexcept { return ticks_.ready(); }
  [[nodiscard]] bool closed() const noexcept { return closed_.load(std::memory_order_acquire); }
  /// After `closed`.
  [[nodiscard]] const ServoStop& stop() const noexcept { return stop_; }

 private:
  SpscRing<ServoTick> ticks_;
  SpscRing<RemovedLeaf> leaves_;
  ServoStop stop_;
  std::atomic<bool> closed_{false};
};

}  // namespace cavum
