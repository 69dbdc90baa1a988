#include "engine/tooth/fill.h"

#include <cmath>
#include <limits>
#include <vector>

namespace cavum {
namespace {

constexpr int k_reach_leaves = 3;  // further than any code of a distance tells

constexpr std::array<IVec3, 6> k_beside{IVec3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0},
                                        {0, -1, 0},     {0, 0, 1},  {0, 0, -1}};

template <class Visit>
void each_leaf(const TissueGrid& grid, const Visit& visit) {
  for (int z = 0; z < grid.size.z; ++z)
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x) visit(IVec3{x, y, z});
}

/// Visits every leaf of the grid within `k_reach_leaves` of `at` along each axis.
template <class Visit>
void around(const TissueGrid& grid, IVec3 at, const Visit& visit) {
  for (int z = -k_reach_leaves; z <= k_reach_leaves; ++z)
    for (int y = -k_reach_leaves; y <= k_reach_leaves; ++y)
      for (int x = -k_reach_leaves; x <= k_reach_leaves; ++x)
        if (const IVec3 leaf = at + IVec3{x, y, z}; grid.inside(leaf)) visit(leaf, IVec3{x, y, z});
}

/// To the nearest leaf of the other kind (solid or not), less half a leaf; with the sign of
/// `solid`.
double leaves_to_surface(const TissueGrid& grid, const std::array<bool, 256>& is_solid, IVec3 at) {
  const bool solid = is_solid[grid.tissue[grid.index(at)]];
  int nearest = std::numeric_limits<int>::max();
  around(grid, at, [&](IVec3 leaf, IVec3 off) {
    if (is_solid[grid.tissue[grid.index(leaf)]] != solid)
      nearest = std::min(nearest, off.x * off.x + off.y * off.y + off.z * off.z);
  });
  const double leaves = nearest == std::numeric_limits<int>::max()
                            ? k_reach_leaves
                            : std::sqrt(static_cast<double>(nearest)) - 0.5;
  return solid ? -leaves : leaves;
}

}  // namespace

Tooth filled_tooth(const Tooth& tooth, const std::array<bool, 256>& tissues) {
  TissueGrid grid = tooth.octree.to_grid();
  std::array<bool, 256> solid{};
  for (const auto& t : tooth.tissues) solid[t.id] = t.solid;
  std::vector<IVec3> reached;
  each_leaf(grid, [&](IVec3 leaf) {
    if (solid[grid.tissue[grid.index(leaf)]]) return;
    if (!tissues[grid.tissue[grid.index(leaf)]]) return;
    for (const IVec3 step : k_beside)
      if (grid.inside(leaf + step) && solid[grid.tissue[grid.index(leaf + step)]]) {
        reached.push_back(leaf);
        return;
      }
  });
  constexpr std::uint8_t k_filled = 1,
                         k_near = 2;  // one byte a leaf for both: a large tooth has 30 million
  std::vector<std::uint8_t> marks(grid.count(), 0);
  const auto is_filled = [&](IVec3 leaf) { return (marks[grid.index(leaf)] & k_filled) != 0; };
  for (std::size_t i = 0; i < reached.size(); ++i) {  // grows while it is walked
    const IVec3 leaf = reached[i];
    if (is_filled(leaf)) continue;
    for (const IVec3 step : k_beside)
      if (grid.inside(leaf + step) && solid[grid.tissue[grid.index(leaf + step)]]) {
        grid.tissue[grid.index(leaf)] = grid.tissue[grid.index(leaf + step)];
        break;
      }
    marks[grid.index(leaf)] = k_filled;
    for (const IVec3 step : k_beside)
      if (const IVec3 next = leaf + step; grid.inside(next) && !is_filled(next) &&
                                          tissues[grid.tissue[grid.index(next)]] &&
                                          !solid[grid.tissue[grid.index(next)]])
        reached.push_back(next);
  }
  each_leaf(grid, [&](IVec3 leaf) {
    if (!is_filled(leaf)) return;
    bool inner =
        true;  // all leaves beside it were filled, too, so that those beside them see to the rest
    for (const IVec3 step : k_beside)
      inner = inner && grid.inside(leaf + step) && is_filled(leaf + step);
    marks[grid.index(leaf)] |= k_near;
    if (!inner) around(grid, leaf, [&](IVec3 other, IVec3) { marks[grid.index(other)] |= k_near; });
  });
  each_leaf(grid, [&](IVec3 leaf) {
    if ((marks[grid.index(leaf)] & k_near) != 0)
      grid.distance[grid.index(leaf)] = encode_distance(leaves_to_surface(grid, solid, leaf));
  });
  grid.make_consistent(tooth.tissues);
  Tooth out{tooth, Octree(grid, tooth.tissues), tooth.tissues};
  out.name += ", filled";
  return out;
}

}  // namespace cavum
