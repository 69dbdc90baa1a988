// What several tests of the tooth need: seeds that are printed, and independent checks of meshes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/tooth/make/make_block.h"
#include "engine/tooth/surface_mesh.h"
#include "engine/tooth/tooth.h"
#include "tests/engine/support/basics.h"

namespace cavum::testing_tooth {

using testing_basics::drawn_seed;

inline double volume_mm3(const Tooth& tooth, std::uint8_t tissue) {
  return static_cast<double>(tooth.octree.count_leaves()[tissue]) * tooth.octree.leaf_volume_mm3();
}

inline Tooth layered_block() {
  return make_block({2.13, 1.9, 2.4},
                    {{"enamel", 0.7}, {"dentin", 0.8}, {"pulp", 0.5}, {"lesion", 0.4}}, 0.1);
}

/// A body to carve: distance from its surface, mm, negative inside.
struct Ball {
  Vec3 centre_mm;
  double radius_mm;
  double operator()(Vec3 mm) const noexcept { return length(mm - centre_mm) - radius_mm; }
};

/// Every edge is used once in each direction: closed, 2-manifold along edges, and consistently
/// oriented.
inline bool is_closed_and_oriented(const TriangleMesh& mesh) {
  std::vector<std::uint64_t> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.push_back(std::uint64_t{t[i]} << 32 | t[(i + 1) % 3]);
  std::sort(edges.begin(), edges.end());
  if (edges.empty() || std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  return std::all_of(edges.begin(), edges.end(), [&](std::uint64_t e) {
    return std::binary_search(edges.begin(), edges.end(), e << 32 | e >> 32);
  });
}

/// Bodies of one tissue, connected by faces.
inline int count_bodies(const TissueGrid& grid, std::uint8_t tissue, std::int32_t from_z,
                        std::int32_t to_z) {
  std::vector<std::uint8_t> seen(grid.count(), 0);
  int bodies = 0;
  std::vector<IVec3> front;
  const IVec3 steps[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const auto enter = [&](IVec3 l) {
    if (!grid.inside(l) || l.z < from_z || l.z > to_z) return false;
    const auto i = grid.index(l);
    if (seen[i] || grid.tissue[i] != tissue) return false;
    seen[i] = 1;
    front.push_back(l);
    return true;
  };
  for (std::int32_t z = from_z; z <= to_z; ++z)
    for (std::int32_t y = 0; y < grid.size.y; ++y)
      for (std::int32_t x = 0; x < grid.size.x; ++x) {
        if (!enter({x, y, z})) continue;
        ++bodies;
        while (!front.empty()) {
          const IVec3 at = front.back();
          front.pop_back();
          for (const IVec3 s : steps) enter(at + s);
        }
      }
  return bodies;
}

}  // namespace cavum::testing_tooth
