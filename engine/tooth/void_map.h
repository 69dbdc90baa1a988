// How far the void tissues (pulp, periodontium) are, coarsely: so that contact need not look for
// them where there are none. Made once from the intact tooth; it stays true while the tooth is cut,
// for cutting only takes tissue away.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/tooth/octree.h"

namespace cavum {

class VoidMap {
 public:
  VoidMap() = default;
  explicit VoidMap(const Octree& tooth);

  /// Lower bound of the distance from `mm` to void tissue, mm; at most about 10 mm. Outside the map
  /// it is that of the nearest place in it: void tissue lies in the map's box, and is no nearer to
  /// a place than to that place's projection on the box.
  [[nodiscard]] double clear_mm(Vec3 mm) const noexcept {
    if (cells_.empty() || !is_finite(mm)) return 0.0;
    const auto within = [](double v, int size) { return std::clamp(v, 0.0, size - 0.5); };
    const Vec3 q = (mm - origin_mm_) * cells_per_mm_,
               p{within(q.x, size_.x), within(q.y, size_.y), within(q.z, size_.z)};
    const auto i = (static_cast<std::size_t>(p.z) * static_cast<std::size_t>(size_.y) +
                    static_cast<std::size_t>(p.y)) *
                       static_cast<std::size_t>(size_.x) +
                   static_cast<std::size_t>(p.x);
    return cells_[i] > 1 ? (cells_[i] - 1) * cell_mm_ : 0.0;
  }

 private:
  static constexpr int k_cell_leaves = 8;
  Vec3 origin_mm_;
  IVec3 size_;
  double cell_mm_ = 1.0, cells_per_mm_ = 1.0;
  std::vector<std::uint8_t> cells_;  // [z][y][x], chessboard distance in cells
};

}  // namespace cavum
