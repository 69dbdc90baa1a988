#include "tests/device/emulated_usb_pedal.h"

#include <hidapi/hidapi.h>

#include <stdexcept>

#include "tests/device/emulated_pedal.h"

namespace cavum::testing_device {
namespace {

EmulatedUsb::Bytes facts_for(std::size_t descriptor_bytes) {
  const auto low = static_cast<std::uint8_t>(descriptor_bytes & 255),
             high = static_cast<std::uint8_t>(descriptor_bytes >> 8);
  return {18,   1,    0x10, 0x01, 0,    0, 0,    8,    0x8e,
          0x06, 0xf2, 0x00, 0x00, 0x01, 1, 2,    0,    1,     // device
          9,    2,    34,   0,    1,    1, 0,    0x80, 50,    // configuration
          9,    4,    0,    0,    1,    3, 0,    0,    0,     // interface
          9,    0x21, 0x10, 0x01, 0,    1, 0x22, low,  high,  // HID
          7,    5,    0x81, 3,    8,    0, 10};
}

}  // namespace

EmulatedUsbPedal::EmulatedUsbPedal() : EmulatedUsbPedal(three_axes_descriptor()) {}

EmulatedUsbPedal::EmulatedUsbPedal(const Bytes& descriptor)
    : EmulatedUsb(1, facts_for(descriptor.size())), descriptor_(descriptor) {
  hid_exit();  // its libusb follows the test bed that was there when it began
  plug_in();
}

EmulatedUsbPedal::~EmulatedUsbPedal() {
  leave();
  hid_exit();
}

bool EmulatedUsbPedal::possible() { return EmulatedPedal::possible(); }

void EmulatedUsbPedal::plugged_in() {
  const auto add = [this](const char* subsystem, const char* name, const char* parent,
                          std::vector<const char*> attributes,
                          std::vector<const char*> properties) {
    attributes.push_back(nullptr);
    properties.push_back(nullptr);
    gchar* made = umockdev_testbed_add_devicev(bed(), subsystem, name, parent,
                                               const_cast<gchar**>(attributes.data()),
                                               const_cast<gchar**>(properties.data()));
    if (made == nullptr) throw std::runtime_error(std::string("umockdev could not add ") + name);
    std::string path = made;
    g_free(made);
    return path;
  };
  interface_ = add("usb", "3-1:1.0", device().c_str(), {"bInterfaceNumber", "00"},
                   {"DEVTYPE", "usb_interface"});
  hid_ = add(
      "hid", "0003:068E:00F2.0001", interface_.c_str(), {},
      {"HID_ID", "0003:0000068E:000000F2", "HID_NAME", "CH Products Pro Pedals", "HID_UNIQ", ""});
  umockdev_testbed_set_attribute_binary(bed(), hid_.c_str(), "report_descriptor",
                                        descriptor_.data(), static_cast<gint>(descriptor_.size()));
  reports_.clear();
  there_ = true;
}

void EmulatedUsbPedal::unplugging() {
  with_lock([&] { there_ = false; });
  for (const std::string* path : {&hid_, &interface_})
    umockdev_testbed_remove_device(bed(), path->c_str());
}

bool EmulatedUsbPedal::report(const Bytes& bytes) {
  const std::lock_guard lock(mutex_);
  if (!there_) return false;
  reports_.push_back(bytes);
  return true;
}

std::optional<EmulatedUsb::Bytes> EmulatedUsbPedal::say(std::size_t,
                                                        std::chrono::steady_clock::time_point) {
  if (reports_.empty()) return std::nullopt;
  Bytes next = std::move(reports_.front());
  reports_.pop_front();
  return next;
}

std::optional<EmulatedUsb::Bytes> EmulatedUsbPedal::control(const Bytes& setup) {
  constexpr std::uint8_t k_get_descriptor = 6, k_get_report = 1;
  if (setup[0] == 0xa1 && setup[1] == k_get_report) {
    ++asked_;
    return std::nullopt;
  }
  if (setup[1] != k_get_descriptor) return Bytes{};
  if (setup[0] == 0x81 && setup[3] == 0x22) return descriptor_;
  if (setup[0] != 0x80 || setup[3] != 3) return std::nullopt;
  if (setup[2] == 0) return Bytes{4, 3, 0x09, 0x04};  // English
  if (setup[2] > 2) return std::nullopt;
  Bytes text{0, 3};
  for (const char c : std::string(setup[2] == 1 ? "CH Products" : "Pro Pedals")) {
    text.push_back(static_cast<std::uint8_t>(c));
    text.push_back(0);
  }
  text[0] = static_cast<std::uint8_t>(text.size());
  return text;
}

}  // namespace cavum::testing_device
