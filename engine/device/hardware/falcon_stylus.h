// A Novint Falcon as a stylus: a thread of its own exchanges a frame with it each millisecond, turns encoders into a place and forces into motor
// commands, and looks for it again when it was unplugged. The servo takes the latest place without waiting.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "engine/device/hardware/falcon_usb.h"
#include "engine/device/hardware/stylus_kind.h"
#include "engine/device/latest_value.h"
#include "engine/device/period_meter.h"
#include "engine/device/stylus.h"

namespace cavum {

class FalconStylus final : public Stylus {
 public:
  /// A place older than this is no longer fresh, and a force older than twice this is not given.
  static constexpr double k_stale_after_s = 0.003, k_force_lasts_s = 0.020;

  /// Waits for no device: one that is not there yet is taken when it comes, and homed (the health says so).
  explicit FalconStylus(const StationStylus& station);
  ~FalconStylus() override;
  FalconStylus(const FalconStylus&) = delete;
  FalconStylus& operator=(const FalconStylus&) = delete;

  [[nodiscard]] DeviceReading read(double elapsed_s) override;
  void send_force(Vec3 force_n) override;
  void cut_force() noexcept override { cut_.store(true, std::memory_order_release); }
  [[nodiscard]] const StylusFacts& facts() const noexcept override { return facts_; }
  [[nodiscard]] StylusHealth health() const override;

 private:
  struct Place {
    Vec3 device_mm;
    std::uint16_t flags = 0;  // buttons
    std::int64_t at_ns = 0;   // 0: none yet
  };
  struct Wanted {
    Vec3 tooth_n;
    std::int64_t at_ns = 0;
  };

  void run();
  void serve(FalconUsb& usb);
  /// Motor command for what the servo wants now.
  [[nodiscard]] std::array<std::int16_t, 3> motors(const FalconAngles& angles, Vec3 at_mm) noexcept;
  void set_problem(const std::string& problem);
  [[nodiscard]] bool wait(double seconds);

  const StationStylus station_;
  const std::string firmware_;
  const FalconGeometry geometry_;
  const FalconDrive drive_;
  const StylusFacts facts_;
  LatestValue<Place> place_;    // from the thread to the servo
  LatestValue<Wanted> wanted_;  // and back
  Place last_;                  // of the servo
  std::atomic<bool> cut_{true};
  PeriodMeter meter_;
  std::atomic<std::int64_t> plugged_in_{0}, unplugged_{0}, forces_cut_{0};
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable stop_asked_;
  std::atomic<bool> stop_{false};  // changed with the mutex held, so that nobody sleeps through it
  std::string problem_ = "stylus falcon: not looked for yet; wait a second";
  std::thread thread_;
};

/// Its record. Peak: 2 lbf, as its maker says; continuous: not published, assumed. Reach: half of the maker's 4 inches.
[[nodiscard]] StylusKind falcon_kind();

}  // namespace cavum
