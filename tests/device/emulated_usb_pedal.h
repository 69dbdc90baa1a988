// A foot pedal that hidapi reaches through libusb instead of hidraw: the same axes and reports as
// emulated_pedal.h, over usbfs.
#pragma once

#include <deque>

#include "tests/device/emulated_usb.h"

namespace cavum::testing_device {

class EmulatedUsbPedal final : public EmulatedUsb {
 public:
  explicit EmulatedUsbPedal(const Bytes& descriptor);
  EmulatedUsbPedal();
  ~EmulatedUsbPedal() override;

  /// True when this program runs under umockdev-wrapper.
  [[nodiscard]] static bool possible();
  bool report(const Bytes& bytes);
  void report_axes(std::uint8_t left, std::uint8_t right, std::uint8_t rudder) {
    report({left, right, rudder});
  }
  [[nodiscard]] static std::string path() { return "3-1:1.0"; }
  /// Times that somebody asked for an input report, which the CH pedals do not answer.
  [[nodiscard]] int asked_for_reports() const {
    const std::lock_guard lock(mutex_);
    return asked_;
  }

 protected:
  std::optional<Bytes> control(const Bytes& setup) override;
  void hear(const Bytes&) override {}
  std::optional<Bytes> say(std::size_t room, std::chrono::steady_clock::time_point since) override;
  void plugged_in() override;
  void unplugging() override;

 private:
  Bytes descriptor_;
  std::string interface_, hid_;
  std::deque<Bytes> reports_;
  bool there_ = false;
  int asked_ = 0;
};

}  // namespace cavum::testing_device
