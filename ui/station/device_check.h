// Before an exam: does the stylus speak, does the pedal reach both ends, does the hand rest on its
// finger rest? The device is read as the servo will read it, in a thread of its own and without any
// force; the screen shows what was found.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include "engine/base/message.h"
#include "engine/physics/servo/servo_device.h"

namespace cavum::station {

/// What the check has seen so far. Rates and places are of the last second.
struct DeviceSight {
  bool read_once = false;
  double rate_hz = 0.0;         ///< of fresh poses
  double usual_rate_hz = 1000;  ///< of this device, when all is well
  Vec3 tip_mm;
  Quat rotation;
  double wander_mm = 1e9;  ///< largest distance of the tip from its mean
  bool pedal_known = false;
  double pedal = 0.0;            ///< 0..1
  bool pedal_released = false;   ///< was seen below 0.05 ...
  bool pedal_pressed = false;    ///< ... and after it above 0.9 ...
  bool pedal_came_back = false;  ///< ... and below 0.05 again
  bool button = false;
  Message error;  ///< of the device, which is no longer read
};

/// One line of the check.
struct CheckItem {
  enum class State { waiting, good, bad };
  State state = State::waiting;
  Message title, detail;
};
/// Stylus, pedal, finger rest.
[[nodiscard]] std::array<CheckItem, 3> check_items(const DeviceSight& sight);
[[nodiscard]] bool all_good(const std::array<CheckItem, 3>& items);

class DeviceCheck {
 public:
  static constexpr double k_min_share = 0.4;      ///< of the usual rate
  static constexpr double k_max_wander_mm = 0.6;  ///< of a hand on its finger rest

  /// `usual_rate_hz`: at which the device speaks when all is well. Reads from now on; the device
  /// must outlive it and be read by nobody else.
  explicit DeviceCheck(ServoDevice& device, double usual_rate_hz = 1000.0);
  /// Stops reading.
  ~DeviceCheck();
  DeviceCheck(const DeviceCheck&) = delete;
  DeviceCheck& operator=(const DeviceCheck&) = delete;
  [[nodiscard]] DeviceSight sight() const;

 private:
  void run() noexcept;

  ServoDevice& device_;
  const double usual_rate_hz_;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  DeviceSight sight_;
  std::thread thread_;
};

}  // namespace cavum::station
