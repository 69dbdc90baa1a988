// What the service of a Haply Inverse3 says and is told: JSON texts, one state for each command.
// Metres and newtons there, mm and N here; quaternions turn from the grip's axes to the device's.
// Sources, and what of them was never seen on a real one: docs/inverse3.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/pose.h"
#include "engine/device/device_error.h"

namespace cavum {

/// One Inverse3, in its own axes: x to the right, y away from the candidate, z up.
struct Inverse3Device {
  std::string id;
  std::optional<Vec3> position_mm;
  std::optional<bool> calibrated, powered;  ///< when the message says so
};

/// One VerseGrip, wireless or wired.
struct Inverse3Grip {
  std::string id;
  std::optional<Quat> to_device;  ///< unit; empty while it tells no direction
  bool button_1 = false, button_2 = false;
};

struct Inverse3Message {
  bool names_session =
      false;  ///< only the first one: the service is 3.5 or later, and takes forces as `vector`
  std::vector<Inverse3Device> devices;
  std::vector<Inverse3Grip> grips;  ///< wireless ones first
};

[[nodiscard]] Error inverse3_error(DeviceError code, Message problem, Message advice);

/// Largest text that is taken, bytes: twenty devices with all their settings have some 40,000.
inline constexpr std::size_t k_inverse3_largest = 64U << 10;

/// Throws Error for what is no such message: no JSON, too large or too deep, an id that is no word,
/// a place beyond 2 m, a number that is none.
[[nodiscard]] Inverse3Message parse_inverse3(std::string_view text);
/// The command "push with `force_n`, N, until the next". `vector`: in the form of 3.5. `id` as
/// parse_inverse3 gave it.
[[nodiscard]] std::string inverse3_command(const std::string& id, Vec3 force_n, bool vector);

}  // namespace cavum
