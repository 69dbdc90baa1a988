#include "tests/device/emulated_falcon.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cavum::testing_device {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// As an FT232 with its maker's numbers: one configuration, one interface, bulk in 0x81 and out
/// 0x02.
const Bytes& usb_descriptors() {
  static const Bytes bytes{18,   1,    0x00, 0x02, 0,    0,    0,    64,   0x03,
                           0x04, 0x48, 0xcb, 0x00, 0x04, 1,    2,    3,    1,   // device
                           9,    2,    32,   0,    1,    1,    0,    0x80, 45,  // configuration
                           9,    4,    0,    0,    2,    0xff, 0xff, 0xff, 0,   // interface
                           7,    5,    0x81, 2,    64,   0,    0,               // in
                           7,    5,    0x02, 2,    64,   0,    0};
  return bytes;
}

constexpr auto k_latency =
    std::chrono::milliseconds(1);  // the chip answers with its status when it has nothing else

}  // namespace

EmulatedFalcon::EmulatedFalcon(bool running, bool homed, UMockdevTestbed* bed)
    : EmulatedUsb(2, usb_descriptors(), bed),
      running_(running),
      homed_(static_cast<std::uint8_t>(homed ? 7 : 0)) {
  move_to(k_falcon_middle_mm);
  plug_in();
}

void EmulatedFalcon::plugged_in() {
  baud_ = loading_ = 0;
  to_host_.clear();
  partial_.clear();
}

void EmulatedFalcon::move_to(Vec3 device_mm) {
  FalconAngles angles{};
  if (!falcon_angles({}, device_mm, angles)) throw std::runtime_error("no arm reaches there");
  with_lock([&] {
    for (std::size_t i = 0; i < 3;
         ++i)  // 320 slots of four edges, a gear of 7.62, 35 degrees at zero
      encoders_[i] = static_cast<std::int16_t>(
          std::lround((angles[i] * 180.0 / M_PI - 35.0) / 360.0 * 7.62 * 1280.0));
  });
}

std::vector<std::uint8_t> EmulatedFalcon::last_frame() const {
  const std::lock_guard lock(mutex_);
  return last_frame_;
}
std::vector<std::uint8_t> EmulatedFalcon::firmware() const {
  const std::lock_guard lock(mutex_);
  return firmware_;
}
std::int64_t EmulatedFalcon::frames() const {
  const std::lock_guard lock(mutex_);
  return frames_;
}
std::vector<std::int16_t> EmulatedFalcon::motors() const {
  const Bytes frame = last_frame();
  std::vector<std::int16_t> values;
  for (std::size_t m = 0; frame.size() == 16 && m < 3; ++m) {
    int value = 0;
    for (std::size_t n = 4; n-- > 0;) value = value * 16 + frame[1 + 4 * m + n] - 'A';
    values.push_back(static_cast<std::int16_t>(value >= 32768 ? value - 65536 : value));
  }
  return values;
}

std::optional<EmulatedUsb::Bytes> EmulatedFalcon::control(const Bytes& setup) {
  if (setup.size() < 8 || setup[0] != 0x40) return std::nullopt;
  const int value = setup[2] | setup[3] << 8;
  if (setup[1] == 0 && value == 1) to_host_.clear();
  if (setup[1] == 0 && value == 2) partial_.clear();
  if (setup[1] == 3) baud_ = value;
  if (setup[1] == 1 && value == 0x101 && baud_ == 0x4138) loading_ = running_ ? 0 : 1;
  return Bytes{};
}

void EmulatedFalcon::hear(const Bytes& bytes) {
  if (silent_) return;
  if (loading_ == 1 && bytes == Bytes{0x0a, 0x43, 0x0d}) {
    for (const int b : {0x0a, 0x44, 0x2c, 0x0d}) to_host_.push_back(static_cast<std::uint8_t>(b));
    loading_ = 2;
  } else if (loading_ == 2 && baud_ == 0x15 && bytes == Bytes{0x41}) {
    to_host_.push_back(0x41);
    loading_ = 3;
    firmware_.clear();
  } else if (loading_ == 3 && baud_ == 0x15) {
    firmware_.insert(firmware_.end(), bytes.begin(), bytes.end());
    for (const std::uint8_t b : bytes)
      to_host_.push_back(static_cast<std::uint8_t>(wrong_echo_ ? b ^ 1 : b));
  } else if (baud_ == 2) {
    if (loading_ == 3) {  // the loader hands over
      running_ = !firmware_.empty();
      loading_ = 0;
    }
    if (!running_) return;
    for (const std::uint8_t b : bytes) {
      if (b == '<') partial_.clear();
      partial_.push_back(b);
      if (b == '>' && partial_.size() == 16) hear_frame(partial_);
    }
  }
}

void EmulatedFalcon::hear_frame(const Bytes& frame) {
  last_frame_ = frame;
  ++frames_;
  Bytes reply{'<'};
  for (const std::int16_t e : encoders_)
    for (int n = 0; n < 4; ++n)
      reply.push_back(
          static_cast<std::uint8_t>('A' + (static_cast<std::uint16_t>(e) >> (4 * n)) % 16));
  reply.push_back(static_cast<std::uint8_t>('A' + homed_ * 16 + buttons_));
  reply.push_back('A');
  reply.push_back('>');
  if (garbled_ && frames_ % 2 == 0) reply[5] = 0x20;
  to_host_.insert(to_host_.end(), reply.begin(), reply.end());
}

std::optional<EmulatedUsb::Bytes> EmulatedFalcon::say(std::size_t room,
                                                      std::chrono::steady_clock::time_point since) {
  if (to_host_.empty() && std::chrono::steady_clock::now() - since < k_latency) return std::nullopt;
  Bytes packet{0x01, 0x60};  // the chip's status
  while (!to_host_.empty() && packet.size() < std::min<std::size_t>(64, room)) {
    packet.push_back(to_host_.front());
    to_host_.pop_front();
  }
  return packet;
}

}  // namespace cavum::testing_device
