// A Novint Falcon that the real libusb talks to: umockdev stands in for /sys and /dev, and this answers what the kernel's usbfs would. It has a
// loader that wants firmware, arms that must be homed, and motors that remember what was sent. Programs that use it run under umockdev-wrapper.
#pragma once

#include <umockdev.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/device/falcon_kinematics.h"

namespace cavum::testing_device {

class EmulatedFalcon {
 public:
  /// Plugs it in, without firmware and not homed unless told otherwise.
  explicit EmulatedFalcon(bool running = true, bool homed = true);
  ~EmulatedFalcon();
  EmulatedFalcon(const EmulatedFalcon&) = delete;
  EmulatedFalcon& operator=(const EmulatedFalcon&) = delete;

  void plug_in();
  void unplug();

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
  [[nodiscard]] std::string node() const { return "/dev/bus/usb/003/00" + std::to_string(number_); }

 private:
  struct Release {
    void operator()(void* object) const noexcept { g_object_unref(object); }
  };
  struct Urb {
    std::shared_ptr<UMockdevIoctlData> urb, buffer;
    std::chrono::steady_clock::time_point submitted;
    bool done = false;
    int status = 0, moved = 0;
  };
  template <class Action>
  void with_lock(const Action& action) const {
    const std::lock_guard lock(mutex_);
    action();
  }
  static gboolean answer(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  void serve(UMockdevIoctlClient* client);
  void control(const std::vector<std::uint8_t>& setup);
  void hear(const std::vector<std::uint8_t>& bytes);
  void hear_frame(const std::vector<std::uint8_t>& frame);
  void settle(Urb& urb);

  mutable std::mutex mutex_;
  std::unique_ptr<UMockdevTestbed, Release> bed_;
  std::unique_ptr<UMockdevIoctlBase, Release> ioctls_;
  std::string device_;
  int number_ = 1;
  bool gone_ = true, running_, silent_ = false, garbled_ = false, wrong_echo_ = false;
  int baud_ = 0, loading_ = 0;  // loading: 0 no, 1 called, 2 ready, 3 takes firmware
  std::uint8_t homed_, buttons_ = 0;
  std::array<std::int16_t, 3> encoders_{};
  std::vector<std::uint8_t> last_frame_, partial_, firmware_;
  std::int64_t frames_ = 0;
  std::deque<std::uint8_t> to_host_;
  std::list<Urb> urbs_;
};

}  // namespace cavum::testing_device
