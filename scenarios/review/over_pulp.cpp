#include "scenarios/review/over_pulp.h"

#include <algorithm>

#include "engine/tooth/distance_transform.h"

namespace cavum::scenarios {
namespace {
constexpr double k_far_from_pulp = 2.0;
}

double planned_over_pulp_mm(const Tooth& tooth, const ZoneMap& zones) {
  const Octree& tree = tooth.octree;
  const auto around = static_cast<int>(k_far_from_pulp / tree.leaf_mm()) + 1;
  LeafBounds box;
  zones.for_each_target_leaf([&](IVec3 leaf) { box.add(leaf); });
  const IVec3 wide{around, around, around}, from = max(IVec3{}, box.low - wide),
                                            size = min(tree.size(), box.high + wide) - from;
  if (size.x <= 0 || size.y <= 0 || size.z <= 0) return k_far_from_pulp;
  const auto row = static_cast<std::size_t>(size.x), layer = row * static_cast<std::size_t>(size.y);
  const auto index = [&](IVec3 c) {
    return static_cast<std::size_t>(c.x) + row * static_cast<std::size_t>(c.y) +
           layer * static_cast<std::size_t>(c.z);
  };
  std::vector<std::uint8_t> pulp(layer * static_cast<std::size_t>(size.z));
  const std::uint8_t id = tooth.tissue_id("pulp");
  Octree::Cursor cursor;
  bool any = false;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x)
        if (tree.tissue(from + IVec3{x, y, z}, cursor) == id)
          pulp[index({x, y, z})] = 1, any = true;
  if (!any) return k_far_from_pulp;
  const auto nearest = nearest_seed(size, pulp);
  double leaves = k_far_from_pulp / tree.leaf_mm();
  zones.for_each_target_leaf([&](IVec3 leaf) {
    const IVec3 at = leaf - from;
    const auto seed = static_cast<std::size_t>(nearest[index(at)]);
    const Vec3 way{at.x - static_cast<double>(seed % row),
                   at.y - static_cast<double>(seed % layer / row),
                   at.z - static_cast<double>(seed / layer)};
    leaves = std::min(leaves, length(way) - 1);  // half a leaf on each side
  });
  return std::max(0.0, leaves) * tree.leaf_mm();
}

}  // namespace cavum::scenarios
