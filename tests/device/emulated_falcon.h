// A Novint Falcon that the real libusb talks to: umockdev stands in for /sys and /dev, and this
// answers what the kernel's usbfs would. It has a loader that wants firmware, arms that must be
// homed, and motors that remember what was sent. Programs that use it run under umockdev-wrapper.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "engine/device/hardware/falcon_kinematics.h"
#include "tests/device/emulated_usb.h"

namespace cavum::testing_device {

class EmulatedFalcon final : public EmulatedUsb {
 public:
  /// Plugs it in, without firmware and not homed unless told otherwise.
  explicit EmulatedFalcon(bool running = true, bool homed = true, UMockdevTestbed* bed = nullptr);
  ~EmulatedFalcon() override { leave(); }

  void move_to(Vec3 device_mm);  ///< encoders follow, rounded to their steps
  void set_homed(std::uint8_t arms) {
    with_lock([&] { homed_ = arms; });
  }
  void press(std::uint8_t buttons) {
    with_lock([&] { buttons_ = buttons; });
  }
  void fall_silent(bool silent) {
    with_lock([&] { silent_ = silent; });
  }
  void garble(bool garbled) {
    with_lock([&] { garbled_ = garbled; });
  }  ///< damages every second answer
  void lose_firmware() {
    with_lock([&] { running_ = false; });
  }
  void take_firmware_wrong(bool wrong) {
    with_lock([&] { wrong_echo_ = wrong; });
  }

  [[nodiscard]] std::vector<std::uint8_t> last_frame() const;  ///< 16 bytes of the last command
  [[nodiscard]] std::vector<std::int16_t> motors() const;      ///< of the last command
  [[nodiscard]] std::vector<std::uint8_t> firmware() const;    ///< as it arrived
  [[nodiscard]] std::int64_t frames() const;

 private:
  std::optional<Bytes> control(const Bytes& setup) override;
  void hear(const Bytes& bytes) override;
  std::optional<Bytes> say(std::size_t room, std::chrono::steady_clock::time_point since) override;
  void plugged_in() override;
  void hear_frame(const std::vector<std::uint8_t>& frame);

  bool running_, silent_ = false, garbled_ = false, wrong_echo_ = false;
  int baud_ = 0, loading_ = 0;  // loading: 0 no, 1 called, 2 ready, 3 takes firmware
  std::uint8_t homed_, buttons_ = 0;
  std::array<std::int16_t, 3> encoders_{};
  std::vector<std::uint8_t> last_frame_, partial_, firmware_;
  std::int64_t frames_ = 0;
  std::deque<std::uint8_t> to_host_;
};

}  // namespace cavum::testing_device
