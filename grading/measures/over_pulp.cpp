#include "grading/measures/over_pulp.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/tooth/octree_edit.h"
#include "grading/measures/solid_surface.h"

namespace cavum::grading {
namespace {

constexpr double k_far_mm = 1e9;

/// Places on the pulp's wall within a cube of leaves.
struct WallBlock {
  std::vector<Vec3> places;
  Vec3 low{k_far_mm, k_far_mm, k_far_mm}, high{-k_far_mm, -k_far_mm, -k_far_mm};

  void add(Vec3 p) {
    places.push_back(p);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  /// No place in it is nearer.
  [[nodiscard]] double at_least_mm(Vec3 p) const {
    const auto outside = [](double v, double from, double to) { return std::max({from - v, v - to, 0.0}); };
    return length({outside(p.x, low.x, high.x), outside(p.y, low.y, high.y), outside(p.z, low.z, high.z)});
  }
};

std::array<bool, 256> pulp_of(const Tooth& tooth) {
  std::array<bool, 256> pulp{};
  for (const auto& t : tooth.tissues) pulp[t.id] = t.name == "pulp";
  return pulp;
}

/// The pulp's wall, in an order that is the same everywhere.
std::vector<WallBlock> wall_of_pulp(const Octree& before, const std::array<bool, 256>& pulp) {
  constexpr int k_block = 16;
  std::map<std::array<int, 3>, WallBlock> blocks;
  Octree::Cursor cursor;
  before.for_each_cube([&](IVec3 at, int edge, std::uint8_t tissue) {
    if (!pulp[tissue]) return;
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
          const bool at_face = x == 0 || y == 0 || z == 0 || x == edge - 1 || y == edge - 1 || z == edge - 1;
          const IVec3 leaf = at + IVec3{x, y, z};
          if (at_face && beside_solid(before, leaf))
            blocks[{leaf.x / k_block, leaf.y / k_block, leaf.z / k_block}].add(surface_by(before, leaf, cursor).at_mm);
        }
  });
  std::vector<WallBlock> out;
  for (auto& [at, block] : blocks) out.push_back(std::move(block));
  return out;
}

}  // namespace

OverPulpMeasures measure_over_pulp(const GradeInput& input, const RemovedMap& removed, std::int64_t last_tick) {
  OverPulpMeasures m;
  m.bound_mm = input.zones.leaf_mm() + input.surface_bound_mm;
  const Octree& before = input.before.octree;
  const std::array<bool, 256> pulp = pulp_of(input.before);
  const std::vector<WallBlock> wall = wall_of_pulp(before, pulp);
  if (wall.empty()) return m;
  Octree::Cursor cursor;
  for (const auto& r : input.removed) {
    const IVec3 leaf = r.leaf.leaf();
    if (r.tick > last_tick || removed.tick(leaf) != r.tick) continue;
    const bool lays_bare = std::any_of(std::begin(scenarios::k_six_neighbours), std::end(scenarios::k_six_neighbours),
                                       [&](IVec3 step) { return pulp[before.tissue(leaf + step)]; });
    if (pulp[r.leaf.tissue] || lays_bare) {
      m.dentin_mm = 0.0;
      m.thinnest = {r.tick, before.centre_mm(leaf)};
      m.pulp_mm = before.centre_mm(leaf);
      return m;
    }
    if (!before.is_solid(r.leaf.tissue) || !beside_solid(input.after, leaf)) continue;
    const Vec3 place = surface_by(input.after, leaf, cursor).at_mm;
    for (const auto& block : wall) {
      if (m.dentin_mm && block.at_least_mm(place) >= *m.dentin_mm) continue;
      for (const Vec3 p : block.places)
        if (const double d = length(p - place); !m.dentin_mm || d < *m.dentin_mm) {
          m.dentin_mm = d;
          m.thinnest = {r.tick, place};
          m.pulp_mm = p;
        }
    }
  }
  return m;
}

}  // namespace cavum::grading
