#include "engine/device/hardware/falcon_protocol.h"

#include <algorithm>

namespace cavum {
namespace {

constexpr std::uint8_t k_zero = 0x41;  // 'A'
constexpr std::uint8_t k_first = '<', k_last = '>';

bool parse(const FalconFrame& frame, FalconAnswer& answer) noexcept {
  FalconAnswer a;
  for (std::size_t motor = 0; motor < 3; ++motor) {
    unsigned value = 0;
    for (std::size_t nibble = 0; nibble < 4; ++nibble) {
      const int digit = frame[1 + 4 * motor + nibble] - k_zero;
      if (digit < 0 || digit > 15) return false;
      value |= static_cast<unsigned>(digit) << (4 * nibble);
    }
    a.encoders[motor] = static_cast<std::int16_t>(static_cast<std::uint16_t>(value));
  }
  const int switches = frame[13] - k_zero;
  if (switches < 0 || switches > 127) return false;
  a.buttons = static_cast<std::uint8_t>(switches & 15);
  a.homed = static_cast<std::uint8_t>(switches >> 4 & 7);
  answer = a;
  return true;
}

}  // namespace

FalconFrame falcon_frame(const FalconCommand& command) noexcept {
  FalconFrame frame{};
  frame.front() = k_first;
  frame.back() = k_last;
  for (std::size_t motor = 0; motor < 3; ++motor) {
    const auto value = static_cast<std::uint16_t>(command.motors[motor]);
    for (std::size_t nibble = 0; nibble < 4; ++nibble)
      frame[1 + 4 * motor + nibble] =
          static_cast<std::uint8_t>(k_zero + (value >> (4 * nibble) & 15));
  }
  frame[13] = static_cast<std::uint8_t>(k_zero + (command.lights | (command.homing ? 1 : 0)));
  frame[14] = k_zero;
  return frame;
}

bool FalconParser::take(std::span<const std::uint8_t> bytes, FalconAnswer& answer) noexcept {
  bool found = false;
  for (const std::uint8_t byte : bytes) {
    if (byte ==
        k_first) {  // no byte of a frame's inside is one: a frame begins here, whatever came before
      if (have_ > 0) ++damaged_;
      have_ = 0;
    } else if (have_ == 0) {
      continue;
    }
    frame_[static_cast<std::size_t>(have_++)] = byte;
    if (byte != k_last && have_ < k_falcon_frame_bytes) continue;
    if (have_ == k_falcon_frame_bytes && byte == k_last && parse(frame_, answer))
      found = true;
    else
      ++damaged_;
    have_ = 0;
  }
  return found;
}

FalconAngles falcon_arm_angles(const FalconDrive& drive,
                               const std::array<std::int16_t, 3>& encoders) noexcept {
  const double step_rad = 2 * k_pi / (drive.encoder_steps * drive.gear);
  FalconAngles angles{};
  for (std::size_t i = 0; i < 3; ++i) angles[i] = drive.arm_offset_rad + step_rad * encoders[i];
  return angles;
}

std::array<std::int16_t, 3> falcon_counts(const FalconDrive& drive,
                                          const std::array<double, 3>& torques_nmm,
                                          bool& cut) noexcept {
  std::array<double, 3> counts{};
  double most = 0.0;
  cut = false;
  for (std::size_t i = 0; i < 3; ++i) {
    counts[i] = -1e-3 * torques_nmm[i] / (drive.gear * drive.nm_per_count);
    if (!(std::fabs(counts[i]) < 1e9)) return {};  // no number: no force
    most = std::max(most, std::fabs(counts[i]));
  }
  cut = most > k_falcon_most_counts;
  const double share = cut ? k_falcon_most_counts / most : 1.0;
  std::array<std::int16_t, 3> whole{};
  for (std::size_t i = 0; i < 3; ++i)
    whole[i] = static_cast<std::int16_t>(std::floor(counts[i] * share + 0.5));
  return whole;
}

}  // namespace cavum
