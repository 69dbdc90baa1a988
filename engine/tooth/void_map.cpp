#include "engine/tooth/void_map.h"

#include <algorithm>

#include "engine/tooth/octree_edit.h"

namespace cavum {

VoidMap::VoidMap(const Octree& tooth)
    : origin_mm_(tooth.origin_mm()),
      cell_mm_(k_cell_leaves * tooth.leaf_mm()),
      cells_per_mm_(1.0 / (k_cell_leaves * tooth.leaf_mm())) {
  const auto cells = [](int leaves) { return (leaves + k_cell_leaves - 1) / k_cell_leaves; };
  size_ = {cells(tooth.size().x), cells(tooth.size().y), cells(tooth.size().z)};
  constexpr std::uint8_t k_far = 25;
  const auto index = [this](int x, int y, int z) {
    return static_cast<std::size_t>((z * size_.y + y) * size_.x + x);
  };
  cells_.assign(index(0, 0, size_.z), k_far);
  tooth.for_each_cube([&](IVec3 low, int edge, std::uint8_t tissue) {
    if (tooth.is_solid(tissue)) return;
    const auto end = [edge](int from, int size) {
      return std::min((from + edge - 1) / k_cell_leaves, size - 1);
    };
    for (int z = low.z / k_cell_leaves; z <= end(low.z, size_.z); ++z)
      for (int y = low.y / k_cell_leaves; y <= end(low.y, size_.y); ++y)
        for (int x = low.x / k_cell_leaves; x <= end(low.x, size_.x); ++x)
          cells_[index(x, y, z)] = 0;
  });
  // chessboard distances grow by one a round: the far value is small, so rounds are few
  for (std::uint8_t d = 0; d + 1 < k_far; ++d) {
    bool any = false;
    for (int z = 0; z < size_.z; ++z)
      for (int y = 0; y < size_.y; ++y)
        for (int x = 0; x < size_.x; ++x) {
          if (cells_[index(x, y, z)] != d) continue;
          any = true;
          for (int k = std::max(z - 1, 0); k <= std::min(z + 1, size_.z - 1); ++k)
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, size_.y - 1); ++j)
              for (int i = std::max(x - 1, 0); i <= std::min(x + 1, size_.x - 1); ++i)
                cells_[index(i, j, k)] =
                    std::min(cells_[index(i, j, k)], static_cast<std::uint8_t>(d + 1));
        }
    if (!any) break;
  }
}

}  // namespace cavum
