// The light of the scene: a lamp over the mouth, to the left and a little beyond, turning with the
// eye, and a room around. The room is a few formulas (sky, wall, tray, window), worked out once
// into what falls on a surface from all sides (spherical harmonics) and what is mirrored by it (a
// small table, at three roughnesses).
#pragma once

#include <array>
#include <cstdint>

#include "ui/station/camera.h"
#include "ui/station/gpu.h"

namespace cavum::station {

/// In the frame of the light: +z occlusal, +y towards the eye, as far as the eye is not above.
class Room {
 public:
  static constexpr int k_edge = 32, k_roughnesses = 3;
  Room();
  /// Coefficients of the light that falls on a surface by its normal, over pi: 1, y, z, x, xy, yz,
  /// 3z²-1, xz, x²-y².
  [[nodiscard]] const std::array<glm::vec3, 9>& falling() const noexcept { return falling_; }
  /// What is mirrored, by direction in an octahedron, one roughness beside the other.
  [[nodiscard]] const Table2D& mirrored() const noexcept { return mirrored_; }

 private:
  std::array<glm::vec3, 9> falling_{};
  Table2D mirrored_;
};

/// The lamp as a camera has it, and the square of the tooth that its shadows are worked out for.
struct Lamp {
  glm::vec3 towards;   ///< unit
  glm::mat4 to_lamp;   ///< tooth frame to the square, -1..1
  glm::mat3 to_room;   ///< tooth frame to the frame of the light
  float texel_mm = 0;  ///< edge of a pixel of the shadow
};
inline constexpr float k_lamp_reach_mm = 8.5F;  ///< half the square's edge
/// `shadow_edge`: pixels.
[[nodiscard]] Lamp lamp_of(const Camera& camera, int shadow_edge);

}  // namespace cavum::station
