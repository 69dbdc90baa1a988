#include "grading/measures/over_pulp.h"

#include <algorithm>
#include <cmath>

#include "engine/tooth/adjacent.h"
#include "engine/tooth/octree_edit.h"
#include "grading/measures/site_blocks.h"
#include "grading/measures/solid_surface.h"

namespace cavum::grading {
namespace {

/// The pulp's wall.
SiteBlocks wall_of_pulp(const Octree& before, const TissueSet& pulp) {
  SiteBlocks wall;
  Octree::Cursor cursor;
  before.for_each_cube([&](IVec3 at, int edge, std::uint8_t tissue) {
    if (!pulp[tissue]) return;
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
          const bool at_face =
              x == 0 || y == 0 || z == 0 || x == edge - 1 || y == edge - 1 || z == edge - 1;
          const IVec3 leaf = at + IVec3{x, y, z};
          if (at_face && beside_solid(before, leaf, cursor))
            wall.add(leaf, surface_by(before, leaf, cursor).at_mm);
        }
  });
  return wall;
}

}  // namespace

OverPulpMeasures measure_over_pulp(const GradeInput& input, const RemovedMap& removed,
                                   std::int64_t last_tick) {
  OverPulpMeasures m;
  m.bound_mm = input.zones.leaf_mm() + input.surface_bound_mm;
  const Octree& before = input.before.octree;
  const TissueSet pulp = tissues_of(input.before, TissueKind::pulp);
  const SiteBlocks wall = wall_of_pulp(before, pulp);
  if (wall.empty()) return m;
  Octree::Cursor cursor, was;
  for (const auto& r : input.removed) {
    const IVec3 leaf = r.leaf.leaf();
    if (r.tick > last_tick || removed.tick(leaf) != r.tick) continue;
    const bool lays_bare =
        std::any_of(std::begin(scenarios::k_six_neighbours), std::end(scenarios::k_six_neighbours),
                    [&](IVec3 step) { return pulp[before.tissue(leaf + step, was)]; });
    if (pulp[r.leaf.tissue] || lays_bare) {
      m.dentin_mm = 0.0;
      m.thinnest = {r.tick, before.centre_mm(leaf)};
      m.pulp_mm = before.centre_mm(leaf);
      return m;
    }
    if (!before.is_solid(r.leaf.tissue) || !beside_solid(input.after, leaf, cursor)) continue;
    const Vec3 place = surface_by(input.after, leaf, cursor).at_mm;
    double nearest_mm = m.dentin_mm.value_or(1e9);
    if (!wall.nearer(place, nearest_mm, m.pulp_mm)) continue;
    m.dentin_mm = nearest_mm;
    m.thinnest = {r.tick, place};
  }
  return m;
}

}  // namespace cavum::grading
