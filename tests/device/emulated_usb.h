// A USB device that the real libusb talks to: umockdev stands in for /sys and /dev, and this
// answers what the kernel's usbfs would. What the device itself says and hears is its own. Programs
// that use it run under umockdev-wrapper.
#pragma once

#include <umockdev.h>

#include <chrono>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace cavum::testing_device {

class EmulatedUsb {
 public:
  using Bytes = std::vector<std::uint8_t>;
  /// `port` 2 is /sys/bus/usb/devices/3-2. `facts`: its device and configuration descriptors, as on
  /// the wire. `bed`: where another device is plugged in already; one of its own when null.
  EmulatedUsb(int port, Bytes facts, UMockdevTestbed* bed = nullptr);
  virtual ~EmulatedUsb();
  EmulatedUsb(const EmulatedUsb&) = delete;
  EmulatedUsb& operator=(const EmulatedUsb&) = delete;

  void plug_in();
  void unplug();
  /// Takes away the right to open it.
  void forbid();
  [[nodiscard]] std::string node() const;

 protected:
  /// With the lock held. A control transfer: eight bytes of setup, and what follows them. Returns
  /// the bytes of a reading one, nothing when the device refuses.
  virtual std::optional<Bytes> control(const Bytes& setup) = 0;
  virtual void hear(const Bytes& bytes) = 0;
  /// What it says to a transfer of `room` bytes that waits since `since`; nothing: let it wait.
  virtual std::optional<Bytes> say(std::size_t room,
                                   std::chrono::steady_clock::time_point since) = 0;
  virtual void plugged_in() {}
  /// Without the lock, before it is taken away.
  virtual void unplugging() {}
  /// Of a derived class' destructor: nobody calls it any more.
  void leave();

  template <class Action>
  void with_lock(const Action& action) const {
    const std::lock_guard lock(mutex_);
    action();
  }
  [[nodiscard]] UMockdevTestbed* bed() const { return bed_.get(); }
  [[nodiscard]] const std::string& device() const { return device_; }
  mutable std::mutex mutex_;

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
  static gboolean answer(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  void serve(UMockdevIoctlClient* client);
  void settle(Urb& urb);

  std::unique_ptr<UMockdevTestbed, Release> bed_;
  std::unique_ptr<UMockdevIoctlBase, Release> ioctls_;
  const int port_;
  const Bytes facts_;
  std::string device_;
  int number_ = 1;
  bool gone_ = true;
  std::list<Urb> urbs_;
};

}  // namespace cavum::testing_device
