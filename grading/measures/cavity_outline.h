// The outlines of cavity and target on the tooth's surface, seen from above: where each begins and
// ends, mesial to distal and buccal to lingual. The borders lie where the distance passes zero
// between leaves, along lines across the topmost ones.
#pragma once

#include "grading/measures/grade_input.h"
#include "grading/measures/removed_map.h"

namespace cavum::grading {

/// Smallest and largest x and y of an area, in leaves from the tooth's corner.
struct Extent {
  double low_x = 1e9, high_x = -1e9, low_y = 1e9, high_y = -1e9;
  [[nodiscard]] bool empty() const { return high_x < low_x; }
  [[nodiscard]] double length() const { return empty() ? 0.0 : high_x - low_x; }
  [[nodiscard]] double width() const { return empty() ? 0.0 : high_y - low_y; }
};

/// Of the cut, of the target, of what belongs to both, and of what belongs to one of them at least.
struct Outlines {
  Extent cut, target, common, either;
};
[[nodiscard]] Outlines cavity_outlines(const GradeInput& input, const RemovedMap& removed,
                                       std::int64_t last_tick);

}  // namespace cavum::grading
