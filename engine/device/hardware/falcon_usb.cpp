#include "engine/device/hardware/falcon_usb.h"

#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

#include "engine/base/file.h"
#include "engine/device/device_error.h"
#include "engine/device/hardware/udev_rule.h"

namespace cavum {
namespace {

constexpr unsigned char k_out = 0x02, k_in = 0x81;
constexpr int k_packet_bytes = 64,
              k_status_bytes = 2;  // each packet of the chip begins with its two status bytes
constexpr unsigned k_patience_ms = 1000;

Error falcon_error(DeviceError code, Message problem, Message advice) {
  return stylus_error("falcon", code, std::move(problem), std::move(advice));
}

// Requests of the FTDI chip and their values.
enum : int { k_reset = 0, k_modem = 1, k_flow = 2, k_baud = 3, k_data = 4, k_latency = 9 };
constexpr int k_purge_in = 1, k_purge_out = 2;
constexpr int k_rts_off = 0x200, k_dtr_off = 0x100, k_dtr_on = 0x101;
constexpr int k_9600_baud = 0x4138, k_140000_baud = 0x15, k_1500000_baud = 0x2, k_8_bits = 8;

struct Context {
  libusb_context* context = nullptr;
  Context() {
    if (libusb_init(&context) != 0)
      throw falcon_error(DeviceError::usb_stopped, msg("libusb does not start"),
                         msg("look whether /dev/bus/usb is there"));
  }
  ~Context() {
    if (context != nullptr) libusb_exit(context);
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  [[nodiscard]] libusb_context* release() { return std::exchange(context, nullptr); }
};

/// The first Falcon, opened. Throws Error.
libusb_device_handle* open_first(libusb_context* context, bool& there) {
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  libusb_device_handle* handle = nullptr;
  int error = LIBUSB_ERROR_NO_DEVICE;
  there = false;
  for (ssize_t i = 0; i < count && handle == nullptr; ++i) {
    libusb_device_descriptor d{};
    if (libusb_get_device_descriptor(list[i], &d) != 0 || d.idVendor != k_falcon_vendor ||
        d.idProduct != k_falcon_product)
      continue;
    there = true;
    error = libusb_open(list[i], &handle);
  }
  if (count >= 0) libusb_free_device_list(list, 1);
  if (!there)
    throw falcon_error(DeviceError::not_there, msg("no Novint Falcon is plugged in"),
                       msg("plug in its USB cable and its own power supply"));
  if (error == LIBUSB_ERROR_ACCESS)
    throw falcon_error(DeviceError::not_permitted, msg("may not be opened"),
                       udev_advice(k_falcon_vendor, k_falcon_product, false));
  if (error != 0)
    throw falcon_error(DeviceError::refuses, msg("does not open ({})", libusb_error_name(error)),
                       msg("plug it in again"));
  return handle;
}

}  // namespace

StylusLook look_for_falcon() {
  StylusLook look;
  try {
    const Context context;
    libusb_close(open_first(context.context, look.there));
  } catch (const Error& e) {
    look.problem = e;
  }
  return look;
}

UsbWatch::UsbWatch() noexcept {
  if (libusb_init(&context_) != 0) context_ = nullptr;
}

UsbWatch::~UsbWatch() {
  if (context_ != nullptr) libusb_exit(context_);
}

FalconUsb::FalconUsb() {
  Context context;
  bool there = false;
  device_ = open_first(context.context, there);
  static_cast<void>(libusb_set_auto_detach_kernel_driver(
      device_, 1));  // a serial port driver may hold it; not every system can
  if (const int error = libusb_claim_interface(device_, 0); error != 0) {
    libusb_close(device_);
    throw falcon_error(DeviceError::in_use, msg("is in use ({})", libusb_error_name(error)),
                       msg("close the other program that drives it"));
  }
  context_ = context.release();
}

FalconUsb::~FalconUsb() {
  libusb_release_interface(device_, 0);
  libusb_close(device_);
  libusb_exit(context_);
}

void FalconUsb::control(int request, int value) {
  constexpr std::uint8_t k_vendor_out = 0x40;
  if (const int error =
          libusb_control_transfer(device_, k_vendor_out, static_cast<std::uint8_t>(request),
                                  static_cast<std::uint16_t>(value), 0, nullptr, 0, k_patience_ms);
      error < 0)
    throw falcon_error(DeviceError::refuses,
                       msg("its USB chip refuses a setting ({})", libusb_error_name(error)),
                       msg("plug it in again"));
}

void FalconUsb::send(std::span<const std::uint8_t> bytes) {
  int sent = 0;
  const int error = libusb_bulk_transfer(device_, k_out, const_cast<unsigned char*>(bytes.data()),
                                         static_cast<int>(bytes.size()), &sent, k_patience_ms);
  if (error != 0 || sent != static_cast<int>(bytes.size()))
    throw falcon_error(DeviceError::refuses,
                       msg("does not take what is sent ({})", libusb_error_name(error)),
                       msg("plug it in again"));
}

std::vector<std::uint8_t> FalconUsb::hear(int patience_ms) {
  std::array<std::uint8_t, k_packet_bytes> packet{};
  int got = 0;
  const int error = libusb_bulk_transfer(device_, k_in, packet.data(), k_packet_bytes, &got,
                                         static_cast<unsigned>(patience_ms));
  if (error != 0 && error != LIBUSB_ERROR_TIMEOUT)
    throw falcon_error(DeviceError::lost, msg("was lost ({})", libusb_error_name(error)),
                       msg("plug it in again"));
  if (got <= k_status_bytes) return {};
  return {packet.begin() + k_status_bytes, packet.begin() + got};
}

void FalconUsb::expect(std::span<const std::uint8_t> wanted, const Message& silent,
                       const Message& otherwise) {
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::milliseconds(k_patience_ms);
  std::vector<std::uint8_t> heard;
  while (heard.size() < wanted.size() && Clock::now() < until) {
    const auto more = hear(50);
    heard.insert(heard.end(), more.begin(), more.end());
  }
  if (heard.size() < wanted.size() || !std::equal(wanted.begin(), wanted.end(), heard.begin()))
    throw falcon_error(heard.empty() ? DeviceError::silent : DeviceError::wrong_firmware,
                       heard.empty() ? silent : otherwise,
                       msg("take it off its power supply for a moment, and begin again"));
}

void FalconUsb::speak_normally() {
  control(k_latency, 1);
  control(k_baud, k_1500000_baud);
  control(k_reset, k_purge_in);
  control(k_reset, k_purge_out);
}

bool FalconUsb::answers() {
  constexpr int k_tries = 20, k_try_ms = 10;
  FalconAnswer answer;
  for (int i = 0; i < k_tries; ++i) {
    const Heard heard = exchange({}, answer, k_try_ms);
    if (heard == Heard::gone)
      throw falcon_error(DeviceError::lost, msg("was lost"), msg("plug it in again"));
    if (heard == Heard::answer) return true;
  }
  return false;
}

void FalconUsb::start(const std::string& firmware) {
  speak_normally();
  if (answers()) return;
  if (firmware.empty())
    throw falcon_error(
        DeviceError::firmware_missing, msg("has no firmware, and its maker's may not be passed on"),
        msg("take nvent_firmware.bin from its maker's driver, and name it as `firmware` in stylus-falcon.toml or in $CAVUM_FALCON_FIRMWARE"));
  const Bytes bytes = read_file(firmware);
  load({bytes.begin(), bytes.end()});
  speak_normally();
  if (!answers())
    throw falcon_error(DeviceError::wrong_firmware, msg("does not run with {}", firmware),
                       msg("name the firmware of its maker's driver"));
  loaded_ = true;
}

void FalconUsb::load(const std::vector<std::uint8_t>& firmware) {
  constexpr std::array<std::uint8_t, 3> k_who{0x0a, 0x43, 0x0d};
  constexpr std::array<std::uint8_t, 4> k_loader{0x0a, 0x44, 0x2c, 0x0d};
  constexpr std::array<std::uint8_t, 1> k_ready{0x41};
  constexpr std::size_t k_piece_bytes = k_packet_bytes - k_status_bytes;
  control(k_reset, k_purge_in);
  control(k_reset, k_purge_out);
  control(k_latency, 16);
  control(k_baud, k_9600_baud);
  control(k_data, k_8_bits);
  control(k_flow, 0);
  for (const int lines : {k_rts_off, k_dtr_off, k_dtr_on}) control(k_modem, lines);
  send(k_who);
  expect(k_loader, msg("is silent when its loader is called"),
         msg("answers something else when its loader is called"));
  control(k_modem, k_dtr_off);
  control(k_baud, k_140000_baud);
  send(k_ready);
  expect(k_ready, msg("is silent when the loading begins"),
         msg("answers something else when the loading begins"));
  for (std::size_t at = 0; at < firmware.size(); at += k_piece_bytes) {
    const auto piece =
        std::span(firmware).subspan(at, std::min(k_piece_bytes, firmware.size() - at));
    send(piece);
    expect(
        piece, msg("is silent while the firmware is loaded"),
        msg("answers something else while the firmware is loaded"));  // it says back what it heard
  }
}

FalconUsb::Heard FalconUsb::exchange(const FalconCommand& command, FalconAnswer& answer,
                                     int patience_ms) noexcept {
  using Clock = std::chrono::steady_clock;
  FalconFrame frame = falcon_frame(command);
  int moved = 0;
  int error = libusb_bulk_transfer(device_, k_out, frame.data(), k_falcon_frame_bytes, &moved,
                                   static_cast<unsigned>(patience_ms));
  const auto gone = [](int e) {
    return e == LIBUSB_ERROR_NO_DEVICE || e == LIBUSB_ERROR_IO || e == LIBUSB_ERROR_PIPE ||
           e == LIBUSB_ERROR_OTHER;
  };
  if (gone(error)) return Heard::gone;
  const auto until = Clock::now() + std::chrono::milliseconds(patience_ms);
  std::array<std::uint8_t, k_packet_bytes> packet{};
  do {
    error = libusb_bulk_transfer(device_, k_in, packet.data(), k_packet_bytes, &moved,
                                 static_cast<unsigned>(patience_ms));
    if (gone(error)) return Heard::gone;
    if (moved > k_status_bytes &&
        parser_.take(std::span(packet).subspan(k_status_bytes,
                                               static_cast<std::size_t>(moved - k_status_bytes)),
                     answer))
      return Heard::answer;
  } while (Clock::now() < until);
  return Heard::silence;
}

}  // namespace cavum
