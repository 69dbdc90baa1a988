// A foot pedal that the real hidapi talks to: umockdev stands in for /sys and /dev, a pseudo
// terminal for /dev/hidrawN. Programs that use it run under umockdev-wrapper.
#pragma once

#include <umockdev.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace cavum::testing_device {

/// Three 8-bit axes, as the CH Pro Pedals are known to have; their own descriptor is not public.
[[nodiscard]] const std::vector<std::uint8_t>& three_axes_descriptor();

class EmulatedPedal {
 public:
  /// Plugs it in as 068e:00f2, unless told otherwise.
  explicit EmulatedPedal(const std::vector<std::uint8_t>& descriptor = three_axes_descriptor());
  ~EmulatedPedal();
  EmulatedPedal(const EmulatedPedal&) = delete;
  EmulatedPedal& operator=(const EmulatedPedal&) = delete;

  /// True when this program runs under umockdev-wrapper.
  [[nodiscard]] static bool possible();

  void plug_in();
  void unplug();
  /// One input report. Returns false when there is nobody to take it.
  bool report(const std::vector<std::uint8_t>& bytes);
  void report_axes(std::uint8_t left, std::uint8_t right, std::uint8_t rudder) {
    report({left, right, rudder});
  }
  /// Takes away the right to open the node.
  void forbid();
  /// Where other devices may be plugged in, too.
  [[nodiscard]] UMockdevTestbed* bed() const { return bed_.get(); }
  /// As hidapi names it.
  [[nodiscard]] std::string path() const { return node(); }
  [[nodiscard]] std::string node() const { return "/dev/hidraw" + std::to_string(number_); }

 private:
  struct Release {
    void operator()(void* object) const noexcept { g_object_unref(object); }
  };
  std::unique_ptr<UMockdevTestbed, Release> bed_;
  std::unique_ptr<UMockdevIoctlBase, Release> ioctls_;
  std::vector<std::uint8_t> descriptor_;
  int number_ = 6;
  std::string usb_, interface_, hid_, raw_;
};

}  // namespace cavum::testing_device
