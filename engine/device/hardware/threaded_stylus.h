// What styluses have in common that a thread of their own speaks with: the servo takes the latest
// place and leaves its latest force without waiting, and what is wrong stands in the health.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "engine/device/hardware/stylus_kind.h"
#include "engine/device/latest_value.h"
#include "engine/device/period_meter.h"
#include "engine/device/stylus.h"

namespace cavum {

class ThreadedStylus : public Stylus {
 public:
  /// A place older than this is no longer fresh, and a force that nobody renewed for the second is
  /// not given.
  static constexpr double k_stale_after_s = 0.003, k_force_lasts_s = 0.020;

  ~ThreadedStylus() override;
  ThreadedStylus(const ThreadedStylus&) = delete;
  ThreadedStylus& operator=(const ThreadedStylus&) = delete;

  [[nodiscard]] DeviceReading read(double elapsed_s) final;
  void send_force(Vec3 force_n) final;
  void cut_force() noexcept final { cut_.store(true, std::memory_order_release); }
  [[nodiscard]] const StylusFacts& facts() const noexcept final { return facts_; }
  [[nodiscard]] StylusHealth health() const final;

 protected:
  struct Place {
    Vec3 device_mm;
    Quat tool_to_device;      ///< where the facts say that it measures directions
    std::uint16_t flags = 0;  ///< buttons
    std::int64_t at_ns = 0;   ///< 0: none yet
  };

  /// Its problem is DeviceError::starting until the thread says otherwise.
  ThreadedStylus(const StationStylus& station, StylusFacts facts);
  /// Begins the thread, once all of the stylus is there.
  void start(std::function<void()> run);
  /// Ends it, while all of the stylus is still there.
  void stop() noexcept;

  // Of the thread:
  /// Serves what it finds, again and again until the end: an exception says what is wrong
  /// meanwhile.
  void look_again_and_again(const std::function<void()>& serve);
  [[nodiscard]] bool is_to_stop() const noexcept { return stop_.load(std::memory_order_relaxed); }
  void set_problem(std::optional<Error> problem);
  void put(const Place& place);
  /// N, in the device's frame; none where the servo wants none, or has not said anything for
  /// k_force_lasts_s. `cut`: it wanted more than the peak.
  [[nodiscard]] Vec3 force_now(bool& cut) noexcept;

  const StationStylus station_;
  const StylusFacts facts_;
  PeriodMeter meter_;
  std::atomic<std::int64_t> plugged_in_{0}, unplugged_{0}, forces_cut_{0};

 private:
  struct Wanted {
    Vec3 tooth_n;
    std::int64_t at_ns = 0;
  };

  [[nodiscard]] bool wait(double seconds);

  LatestValue<Place> place_;    // from the thread to the servo
  LatestValue<Wanted> wanted_;  // and back
  Place last_;                  // of the servo
  std::atomic<bool> cut_{true};
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable stop_asked_;
  std::atomic<bool> stop_{false};  // changed with the mutex held, so that nobody sleeps through it
  std::optional<Error> problem_;
  std::thread thread_;
};

}  // namespace cavum
