#include "grading/trial/coarse_tooth.h"

#include <array>

namespace cavum::grading {

Tooth coarse_tooth(const Tooth& tooth) {
  const TissueGrid fine = tooth.octree.to_grid();
  TissueGrid grid;
  const auto half = [](int n) { return (n + 1) / 2; };
  grid.allocate({half(fine.size.x), half(fine.size.y), half(fine.size.z)}, 2 * fine.leaf_mm,
                fine.origin_mm);
  const Octree& tree = tooth.octree;
  std::size_t i = 0;
  for (int z = 0; z < grid.size.z; ++z)
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x, ++i) {
        std::array<std::uint8_t, 8> label{};
        int sum = 0;
        for (int k = 0; k < 8; ++k) {
          const IVec3 leaf{2 * x + (k & 1), 2 * y + (k >> 1 & 1), 2 * z + (k >> 2)};
          const bool in = fine.inside(leaf);
          label[static_cast<std::size_t>(k)] =
              in ? fine.tissue[fine.index(leaf)] : std::uint8_t{k_air};
          sum += in ? fine.distance[fine.index(leaf)] : k_distance_far;
        }
        const bool solid = sum < 0;
        int most = 0;
        for (const std::uint8_t one : label) {
          int count = 0;
          for (const std::uint8_t other : label) count += other == one ? 1 : 0;
          if (tree.is_solid(one) != solid || count <= most) continue;
          most = count;
          grid.tissue[i] = one;
        }
        grid.distance[i] = encode_distance(decode_distance(sum) / 16);
      }
  grid.make_consistent(tooth.tissues);
  Tooth coarse = tooth;
  coarse.octree = Octree(grid, tooth.tissues);
  return coarse;
}

}  // namespace cavum::grading
