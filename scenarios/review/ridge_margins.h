// How much of the marginal ridges a cavity along the fissure leaves, measured on the outline as it
// will be laid.
#pragma once

#include <array>
#include <vector>

#include "engine/tooth/anatomy/landmarks.h"

namespace cavum::scenarios {

struct RidgeMargin {
  double ridge_mm = 0;  ///< of the outline, from the crest's lowest place
  double left_mm =
      0;  ///< from the outline to the nearest place of a crest, or `ridge_mm` where that is less
};
struct RidgeMargins {
  std::vector<RidgeMargin> may;     ///< best first
  std::array<bool, 2> pits_left{};  ///< by all of them: the mesial, the distal pit lies outside
  Message why_none;                 ///< where there is none
};

/// Of an outline `width_mm` wide that goes `through` the mesial (+1), the distal (-1) or neither
/// ridge (0). Only what takes in the pits that can be taken in, for a pit that stays is caries
/// left; and only what leaves half a millimetre up to the crest as it was found. A crest stands a
/// millimetre inside the proximal surface, so 0.7 mm are the least that leaves a ridge of 1.6 mm.
[[nodiscard]] RidgeMargins ridge_margins(const Landmarks& landmarks, double width_mm, int through);

}  // namespace cavum::scenarios
