// The wire to a Novint Falcon: its FTDI chip over libusb, the loading of its firmware, and the
// exchange of one frame for one answer. Blocks; it belongs to a thread of its own.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/device/hardware/falcon_protocol.h"
#include "engine/device/hardware/stylus_kind.h"

struct libusb_context;
struct libusb_device_handle;

namespace cavum {

inline constexpr std::uint16_t k_falcon_vendor = 0x0403, k_falcon_product = 0xcb48;

/// Whether one is plugged in, and may be opened.
[[nodiscard]] StylusLook look_for_falcon();

/// libusb watches what is plugged in as long as anybody uses it. Held between one search and the
/// next, it need not begin anew each time, and misses nothing in between.
class UsbWatch {
 public:
  UsbWatch() noexcept;  ///< where libusb does not start, the search says so
  ~UsbWatch();
  UsbWatch(const UsbWatch&) = delete;
  UsbWatch& operator=(const UsbWatch&) = delete;

 private:
  libusb_context* context_ = nullptr;
};

class FalconUsb {
 public:
  /// Opens the first Falcon. Throws Error when there is none, or it may not be opened (with the
  /// udev rule).
  FalconUsb();
  ~FalconUsb();
  FalconUsb(const FalconUsb&) = delete;
  FalconUsb& operator=(const FalconUsb&) = delete;

  /// Makes it answer: loads the firmware in the file `firmware` unless it runs already. Throws
  /// Error when there is none, it is no such file, or the Falcon does not take it.
  void start(const std::string& firmware);
  [[nodiscard]] bool loaded() const noexcept {
    return loaded_;
  }  ///< `start` had to load the firmware

  enum class Heard { answer, silence, gone };
  /// Sends `command` and waits for its answer.
  Heard exchange(const FalconCommand& command, FalconAnswer& answer, int patience_ms) noexcept;
  [[nodiscard]] std::int64_t damaged() const noexcept { return parser_.damaged(); }

 private:
  void control(int request, int value);
  void send(std::span<const std::uint8_t> bytes);
  /// What came within `patience_ms`, without the status bytes of the chip; may be nothing.
  std::vector<std::uint8_t> hear(int patience_ms);
  void expect(std::span<const std::uint8_t> wanted, const Message& silent,
              const Message& otherwise);
  bool answers();
  void speak_normally();
  void load(const std::vector<std::uint8_t>& firmware);

  libusb_context* context_ = nullptr;
  libusb_device_handle* device_ = nullptr;
  FalconParser parser_;
  bool loaded_ = false;
};

}  // namespace cavum
