// A Touch or PHANTOM Omni through OpenHaptics, whose library is loaded while the program runs:
// nothing of it is needed to build. Its own scheduler calls back a thousand times a second; the
// callback exchanges the latest place for the latest force and does nothing else.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "engine/device/hardware/stylus_kind.h"
#include "engine/device/latest_value.h"
#include "engine/device/period_meter.h"
#include "engine/device/stylus.h"

namespace cavum {

/// Whether the library is there and, with `begin`, its device begins. Not to be begun again and
/// again.
[[nodiscard]] StylusLook look_for_touch(const StationStylus& station, bool begin);

class OpenHapticsStylus final : public Stylus {
 public:
  static constexpr double k_stale_after_s = 0.003, k_force_lasts_s = 0.020;

  /// Begins the device of `station`. Throws Error without the library, one of its functions, or the
  /// device. One that is not calibrated is opened; its health says what to do.
  explicit OpenHapticsStylus(const StationStylus& station);
  ~OpenHapticsStylus() override;
  OpenHapticsStylus(const OpenHapticsStylus&) = delete;
  OpenHapticsStylus& operator=(const OpenHapticsStylus&) = delete;

  [[nodiscard]] DeviceReading read(double elapsed_s) override;
  void send_force(Vec3 force_n) override;
  void cut_force() noexcept override { cut_.store(true, std::memory_order_release); }
  [[nodiscard]] const StylusFacts& facts() const noexcept override { return facts_; }
  [[nodiscard]] StylusHealth health() const override;

  struct Library;

 private:
  struct Place {
    Vec3 device_mm;
    Quat tool_to_device;
    std::uint16_t flags = 0;  // buttons
    std::int64_t at_ns = 0;   // 0: none yet
  };
  struct Wanted {
    Vec3 tooth_n;
    std::int64_t at_ns = 0;
  };
  static unsigned call(void* self);
  void exchange() noexcept;
  /// False while the device does not know its place.
  bool calibrated() noexcept;
  [[nodiscard]] Vec3 force_now() noexcept;

  const StationStylus station_;
  const std::shared_ptr<Library> library_;
  unsigned handle_;
  StylusFacts facts_;
  LatestValue<Place> place_;    // from the scheduler's thread to the servo
  LatestValue<Wanted> wanted_;  // and back
  Place last_;                  // of the servo
  PeriodMeter meter_;
  bool is_calibrated_ = false;  // of the scheduler's thread
  int until_look_ = 0;
  std::atomic<unsigned> calibration_{0}, error_{0};  // last said; 0 = none
  std::atomic<bool> cut_{true}, closing_{false}, closed_{false};
  std::atomic<std::int64_t> forces_cut_{0}, errors_{0};
  unsigned long task_ = 0;
};

/// Its record. Ratings are the Omni's, unless the device says its own; reach: half the depth of the
/// Omni's workspace (recalled).
[[nodiscard]] StylusKind touch_kind();

}  // namespace cavum
