// Foot pedals over USB HID, through hidapi: the CH Pro Pedals (068e:00f2) and every other device
// whose report descriptor names an axis. The descriptor comes from sysfs, for hidapi 0.13 has no
// call for it; no report is ever asked for (the Linux kernel marks the CH pedals as not answering),
// so a pedal is unknown until it speaks.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/error.h"
#include "engine/device/hardware/hid_descriptor.h"
#include "engine/device/hardware/udev_rule.h"
#include "engine/device/pedal.h"

namespace cavum {

/// A HID device with at least one axis, or one whose descriptor cannot be had (`problem` says why).
struct HidPedalInfo {
  std::uint16_t vendor = 0, product = 0;
  std::string name, path;  ///< path as hidapi names it
  std::vector<HidField> axes;
  std::optional<Error> problem = {};  ///< why it cannot be opened

  /// "068e:00f2"
  [[nodiscard]] std::string id() const;
};

/// Every HID device that could be a pedal. Keyboards, mice and whatever else has no absolute axis
/// are left out.
[[nodiscard]] std::vector<HidPedalInfo> list_hid_pedals();

/// What a device said while nobody used it.
struct PedalHearing {
  std::int64_t reports = 0;
  double mean_period_s = 0.0, jitter_s = 0.0,
         longest_gap_s = 0.0;  ///< jitter: standard deviation of the periods; 0 below two reports
  std::vector<std::vector<std::int32_t>> numbers;  ///< of each axis, one a report
  std::vector<std::int64_t> ranges;                ///< of each axis, as its descriptor has it
};
/// Listens for `seconds`. Throws Error when there is no such pedal, it may not be opened, or it is
/// unplugged meanwhile.
[[nodiscard]] PedalHearing hear_pedal(std::uint16_t vendor, std::uint16_t product, double seconds);

struct HidPedalCounts {
  std::int64_t reports = 0,
               foreign_reports = 0;  ///< reports understood; of another number or too short
  std::int64_t plugged_in = 0, unplugged = 0;
  double longest_gap_s = 0.0;  ///< between two reports of one plugging-in
};

/// A pedal read by a thread of its own, found again when it is plugged in anew.
class HidPedal final : public Pedal {
 public:
  /// A continuous pedal silent for longer is unknown.
  static constexpr double k_stale_after_s = 0.040;

  /// Waits for no device: one that is not there yet is taken when it comes. `path` chooses one of
  /// several equal ones.
  HidPedal(std::uint16_t vendor, std::uint16_t product, PedalCalibration calibration,
           std::string path = {});
  ~HidPedal() override;
  HidPedal(const HidPedal&) = delete;
  HidPedal& operator=(const HidPedal&) = delete;

  [[nodiscard]] PedalReading read() noexcept override;
  [[nodiscard]] HidPedalCounts counts() const;
  /// Why there is no pedal; none while one is open.
  [[nodiscard]] std::optional<Error> problem() const;

  struct Open;

 private:
  void run();
  void serve(Open& open);
  void hear(std::int32_t raw, const HidField& axis);
  void forget(Error why);
  [[nodiscard]] bool wait(double seconds);

  const std::uint16_t vendor_, product_;
  const PedalCalibration calibration_;
  const std::string path_;
  /// Time of the last report, microseconds, above sixteen bits of position; 0 = unknown. One word,
  /// so that no reader needs a lock.
  std::atomic<std::uint64_t> latest_{0};
  mutable std::mutex mutex_;  // of what follows
  std::condition_variable stop_asked_;
  bool stop_ = false;
  HidPedalCounts counts_;
  std::optional<Error> problem_;
  std::thread thread_;
};

}  // namespace cavum
