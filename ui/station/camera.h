// How one looks at the tooth: round it, nearer and farther, as in a mouth mirror, or with both
// eyes. Matrices for the screen only; nothing of them reaches the physics.
#pragma once

#include <glm/glm.hpp>

#include "engine/base/vec.h"

namespace cavum::station {

struct Camera {
  glm::vec3 target_mm{0, 0, 0};
  float turn_deg = 0.0F;       ///< round the tooth; 0 = seen from buccal, 90 = from distal
  float rise_deg = 52.0F;      ///< 0 = from the side, 90 = from occlusal
  float roll_deg = 0.0F;       ///< of the picture
  float distance_mm = 42.0F;   ///< 8..120
  bool mirror = false;         ///< left and right change places, as in a mouth mirror
  float eyes_apart_mm = 0.0F;  ///< half of it to each side in stereo

  void orbit(float turn, float rise);
  void approach(float factor);  ///< nearer below 1
  void look_from_occlusal();
  void look_from(float turn, float rise);

  /// `eye` -1 left, +1 right, 0 one eye for both.
  [[nodiscard]] glm::mat4 view(int eye = 0) const;
  [[nodiscard]] glm::mat4 projection(float width_over_height) const;
  [[nodiscard]] glm::vec3 position_mm(int eye = 0) const;
  /// What is to the right and up in the picture, tooth frame, unit.
  [[nodiscard]] Vec3 right() const;
  [[nodiscard]] Vec3 up() const;
  friend bool operator==(const Camera&, const Camera&) = default;
};

}  // namespace cavum::station
