// What stands on the station's desk beside stylus and pedal: the tray with the burs, the speed
// dial, the pause key, the office's pause. What is chosen there becomes part of the reading, so
// that it is recorded and replayed like the hand's motion.
#pragma once

#include <algorithm>
#include <atomic>

#include "engine/physics/servo/servo_device.h"

namespace cavum {

/// Set by the window, read by the servo; never waits.
struct Desk {
  std::atomic<int> bur{-1};  ///< of the tray; -1 = as the device says
  std::atomic<double> speed_share{
      1.0};  ///< of the handpiece's highest speed at a pedal pressed to the floor, 0..1
  std::atomic<std::uint32_t> buttons{0};  ///< k_button_1, k_button_2: held on the keyboard
  std::atomic<bool> hold{
      false};  ///< the exam office has paused the exam: the pedal counts as released
};

class WithDesk final : public ServoDevice {
 public:
  /// Both must outlive it.
  WithDesk(ServoDevice& device, const Desk& desk) : device_(device), desk_(desk) {}

  [[nodiscard]] DeviceReading read(double elapsed_s) override {
    DeviceReading reading = device_.read(elapsed_s);
    const int bur = desk_.bur.load(std::memory_order_relaxed);
    if (bur >= 0) reading.bur = static_cast<std::uint8_t>(std::min(bur, 255));
    reading.pedal *= desk_.speed_share.load(std::memory_order_relaxed);
    reading.flags =
        static_cast<std::uint16_t>(reading.flags | (desk_.buttons.load(std::memory_order_relaxed) &
                                                    (k_button_1 | k_button_2)));
    if (desk_.hold.load(std::memory_order_relaxed)) {
      reading.flags = static_cast<std::uint16_t>(reading.flags | k_hold);
      reading.pedal = 0.0;
    }
    return reading;
  }
  void show(const TickOutput& output) noexcept override { device_.show(output); }
  void send_force(Vec3 force_n) override { device_.send_force(force_n); }
  void cut_force() noexcept override { device_.cut_force(); }

 private:
  ServoDevice& device_;
  const Desk& desk_;
};

}  // namespace cavum
