// The outside of a tooth seen from all sides: where a ray towards the long axis first meets it, and
// which tissue it meets. From it come the height of contour, the neck (cemento-enamel junction) and
// the crown's widths.
#pragma once

#include <vector>

#include "engine/tooth/anatomy/crown_frame.h"

namespace cavum {

struct CrownWalls {
  static constexpr int k_directions = 72;  ///< every 5 degrees, counter-clockwise from +x
  static constexpr double k_row_mm = 0.1;
  Vec3 middle;  ///< the axis runs through it, in the crown's frame
  double low_z = 0.0;
  int rows = 0;
  std::vector<double>
      radius_mm;  ///< by row and direction (direction fastest); below 0 where the ray meets nothing
  std::vector<std::uint8_t> tissue;  ///< of the first solid leaf

  [[nodiscard]] std::size_t index(int row, int direction) const noexcept {
    return static_cast<std::size_t>(row) * k_directions + static_cast<std::size_t>(direction);
  }
  [[nodiscard]] double row_z(int row) const noexcept { return low_z + row * k_row_mm; }
  /// In the crown's frame.
  [[nodiscard]] Vec3 place(int row, int direction) const noexcept;
};

/// Rows from 2.5 mm below the enamel's lowest place to the top.
[[nodiscard]] CrownWalls crown_walls(const Tooth& tooth, const CrownFrame& frame);

/// The widest place of the crown in every direction (row per direction); the middle of a stretch
/// that is equally wide to 0.02 mm. -1: nothing there.
[[nodiscard]] std::vector<int> contour_rows(const CrownWalls& walls, const TissueIds& ids);

/// The neck: lowest row of enamel, going down from the height of contour until 0.3 mm are something
/// else. Places between rows and directions that have none, or one more than 1 mm off their
/// neighbours, are bridged; empty when more than a quarter of them are.
[[nodiscard]] std::vector<Vec3> neck_line(const CrownWalls& walls, const std::vector<int>& contour,
                                          const TissueIds& ids);

}  // namespace cavum
