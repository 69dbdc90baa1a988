// Where buccal and mesial are, by the shape of a crown and its roots: what tells a frame that is
// turned about the long axis, or a tooth of the other side of the jaw. What shape cannot tell is
// absent. Signs, sources and how often they were right: docs/anatomy.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/tooth_number.h"

namespace cavum {

/// A direction in the plane across the long axis, degrees counter-clockwise from where the frame
/// has it, -180 to 180.
struct SeenTurn {
  double deg = 0.0;
  bool line = false;  ///< it may as well be the opposite one: -90 to 90
  Message reason;
};

/// What the shape says, in a frame whose +x should be mesial and +y buccal.
struct Orientation {
  std::optional<SeenTurn> turn;            ///< by the surest sign that the tooth has
  bool buccal_told = false;                ///< the turn is of the buccal side, not only of a line
  int mesial_for = 0, mesial_against = 0;  ///< signs that put mesial towards +x, or towards -x
  std::vector<Message> mesial_signs;

  /// +1 or -1 where at least three signs agree and none is against; else 0.
  [[nodiscard]] int mesial() const noexcept {
    constexpr int k_enough = 3;
    return mesial_against == 0 && mesial_for >= k_enough   ? 1
           : mesial_for == 0 && mesial_against >= k_enough ? -1
                                                           : 0;
  }
};

/// By the class that is said (`number`), else by that which is seen.
[[nodiscard]] Orientation seen_orientation(const Landmarks& landmarks,
                                           const std::optional<ToothNumber>& number);

}  // namespace cavum
