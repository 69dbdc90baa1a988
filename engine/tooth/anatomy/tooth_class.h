// Incisor, canine, premolar or molar? Told by the shape of the crown's top and by its size, and
// only where they agree.
#pragma once

#include <optional>

#include "engine/tooth/anatomy/crown_walls.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/anatomy/occlusal_marks.h"

namespace cavum {

/// What the class is told by, mm.
struct ClassSigns {
  double wide_x_mm = 0,
         wide_y_mm = 0;  ///< the crown's widths at the height of contour, along the frame's x and y
  double long_mm = 0, short_mm = 0;  ///< its largest width, and the width across that
  double top_long_mm = 0,
         top_short_mm = 0;  ///< length and width of what stands within 1 mm of the highest place
  double level_share =
      0;  ///< of the crown seen from above: what stands within 0.05 mm of the highest place
  std::size_t cusps = 0;
  bool table = false;
};
[[nodiscard]] ClassSigns class_signs(const CrownWalls& walls, const std::vector<int>& contour,
                                     const HeightMap& map, std::size_t cusps, bool table);
[[nodiscard]] ClassGuess guess_class(const ClassSigns& signs);

}  // namespace cavum
