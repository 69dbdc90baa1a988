// What a Novint Falcon with its maker's firmware says and hears: frames of 16 bytes between '<' and
// '>', three numbers of 16 bits as four nibbles each, lowest first, every nibble carried by 'A' to
// 'P', then one byte of switches and one that is empty.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/base/vec.h"
#include "engine/device/hardware/falcon_kinematics.h"

namespace cavum {

inline constexpr int k_falcon_frame_bytes = 16;
using FalconFrame = std::array<std::uint8_t, k_falcon_frame_bytes>;

/// Lights of the grip's ring, as bits of FalconCommand::lights.
enum FalconLight : std::uint8_t { k_falcon_green = 2, k_falcon_blue = 4, k_falcon_red = 8 };

struct FalconCommand {
  std::array<std::int16_t, 3> motors{};  ///< counts, within ±k_falcon_most_counts
  std::uint8_t lights = 0;
  bool homing = false;  ///< look for the arms' zero marks
  friend bool operator==(const FalconCommand&, const FalconCommand&) = default;
};
struct FalconAnswer {
  std::array<std::int16_t, 3> encoders{};
  std::uint8_t homed = 0;    ///< one bit an arm; 7 = all have found their zero
  std::uint8_t buttons = 0;  ///< four bits of the grip
  friend bool operator==(const FalconAnswer&, const FalconAnswer&) = default;
};

[[nodiscard]] FalconFrame falcon_frame(const FalconCommand& command) noexcept;

/// Finds answers in a stream of bytes that may begin, end and be damaged anywhere.
class FalconParser {
 public:
  /// Takes `bytes`; true when an answer was complete, then the last one is in `answer`.
  bool take(std::span<const std::uint8_t> bytes, FalconAnswer& answer) noexcept;
  [[nodiscard]] std::int64_t damaged() const noexcept { return damaged_; }  ///< frames given up

 private:
  FalconFrame frame_{};
  int have_ = 0;
  std::int64_t damaged_ = 0;
};

/// Step of the places it reports: a little above the largest way of the grip per encoder step in
/// the middle 80 mm of its workspace.
inline constexpr double k_falcon_quantum_mm = 0.06;
/// The largest motor command.
inline constexpr int k_falcon_most_counts = 4096;

/// Motors and encoders. Source: S. Martin and N. Hillier, "Characterisation of the Novint Falcon
/// haptic device for application as a robot manipulator", ACRA 2009.
struct FalconDrive {
  double encoder_steps = 1280.0;    ///< a turn of the motor: 320 slots, four edges each
  double gear = 7.62;               ///< turns of the motor per turn of an arm
  double nm_per_count = 1.9835e-5;  ///< torque of the motor at rest
  double arm_offset_rad =
      35.0 * k_pi / 180.0;  ///< of the arms at encoder 0; sources say 35 to 50 degrees
};
[[nodiscard]] FalconAngles falcon_arm_angles(const FalconDrive& drive,
                                             const std::array<std::int16_t, 3>& encoders) noexcept;
/// Counts for these torques of the arms; positive counts pull the arms back. Above the largest
/// command all three shrink together, so that the force keeps its direction; `cut` says whether
/// they did.
[[nodiscard]] std::array<std::int16_t, 3> falcon_counts(const FalconDrive& drive,
                                                        const std::array<double, 3>& torques_nmm,
                                                        bool& cut) noexcept;

}  // namespace cavum
