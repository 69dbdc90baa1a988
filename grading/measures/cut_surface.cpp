#include "grading/measures/cut_surface.h"

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"
#include "grading/measures/bounds.h"
#include "grading/measures/cavity_outline.h"
#include "grading/measures/solid_surface.h"

namespace cavum::grading {

namespace {

struct Sample {
  double deviation_mm;
  std::int64_t tick;
  Vec3 place;
};

/// Walls that a place may belong to: its own, and those within a leaf.
unsigned walls_around(const scenarios::ZoneMap& zones, IVec3 leaf) {
  unsigned walls = 1u << static_cast<unsigned>(zones.wall(leaf));
  for (const IVec3 step : scenarios::k_six_neighbours)
    walls |= 1u << static_cast<unsigned>(zones.wall(leaf + step));
  return walls;
}

WallMeasures summary(std::vector<Sample>& samples) {
  WallMeasures w;
  w.samples = samples.size();
  if (samples.empty()) return w;
  std::stable_sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return a.deviation_mm < b.deviation_mm;
  });
  double sum = 0;
  for (const auto& s : samples) sum += s.deviation_mm;
  w.mean_mm = sum / static_cast<double>(samples.size());
  const std::size_t rank = (samples.size() * 95 + 99) / 100;  // nearest rank
  w.p95_mm = samples[rank - 1].deviation_mm;
  w.max_over_mm = std::max(0.0, samples.back().deviation_mm);
  w.max_under_mm = std::max(0.0, -samples.front().deviation_mm);
  if (w.max_over_mm > 0) w.worst_over = {samples.back().tick, samples.back().place};
  if (w.max_under_mm > 0) w.worst_under = {samples.front().tick, samples.front().place};
  return w;
}

/// The surface that was left, wall by wall.
struct WallSurface {
  std::array<std::vector<Sample>, scenarios::k_walls> samples;
  std::array<WallValues, scenarios::k_walls> values;  // the same deviations, for the bounds
  std::vector<WallHeight> sides = std::vector<WallHeight>(scenarios::k_side_walls);
  double up = 0, across = 0;  // sums of the side walls' normals

  /// A place of the wall `own` that may belong to any wall of the set `around`.
  void count(scenarios::Wall own, unsigned around, double deviation) {
    const auto w = static_cast<std::size_t>(own);
    for (std::size_t i = 0; i < scenarios::k_walls; ++i)
      if ((around >> i & 1u) != 0)
        (i != w              ? values[i].of_others
         : around == 1u << i ? values[i].sure
                             : values[i].own)
            .push_back(deviation);
  }
  /// A place of a side wall, for its taper; `normal` out of the solid.
  void lean(scenarios::Wall side, Vec3 place, Vec3 normal) {
    WallHeight& wall = sides[static_cast<std::size_t>(side)];
    wall.places += 1;
    wall.low_mm = std::min(wall.low_mm, place.z);
    wall.high_mm = std::max(wall.high_mm, place.z);
    up += normal.z;
    across += std::sqrt(normal.x * normal.x + normal.y * normal.y);
  }
};

/// One sample for each removed leaf with solid tissue left beside it: its place on the surface, and
/// how far that lies from the target's.
WallSurface sample_walls(const GradeInput& input, const RemovedMap& removed,
                         std::int64_t last_tick) {
  const scenarios::ZoneMap& zones = input.zones;
  const Octree& before = input.before.octree;
  const scenarios::Facing facing = zones.facing();
  WallSurface surface;
  Octree::Cursor cursor;
  for_each_removed(input.removed, removed, last_tick, [&](const RemovedAt& r) {
    const IVec3 leaf = r.leaf.leaf();
    if (!beside_solid(input.after, leaf, cursor)) return;
    const auto [place, normal] = surface_by(input.after, leaf, cursor);
    const double deviation = zones.distance_mm(place);
    if (!before.is_solid(r.leaf.tissue) && deviation > 0) return;
    const IVec3 where = zones.in_box(before.leaf_at(place)) ? before.leaf_at(place) : leaf;
    const scenarios::Wall wall = zones.wall(where);
    surface.count(wall, walls_around(zones, where), deviation);
    if (wall == scenarios::Wall::opening) return;
    surface.samples[static_cast<std::size_t>(wall)].push_back({deviation, r.tick, place});
    const Vec3 leans = facing.local(normal);
    if (wall != scenarios::Wall::floor && std::fabs(leans.z) < 0.70710678118654752440)
      surface.lean(wall, facing.local(place), leans);
  });
  return surface;
}

/// The removed hard leaf that lies furthest beyond the target, towards each wall; where the next
/// one belongs to another wall and is gone as well, the face between them.
std::array<Sample, scenarios::k_walls> furthest_removed(const GradeInput& input,
                                                        const RemovedMap& removed,
                                                        std::int64_t last_tick) {
  std::array<Sample, scenarios::k_walls> furthest{};
  for_each_removed(input.removed, removed, last_tick, [&](const RemovedAt& r) {
    const IVec3 leaf = r.leaf.leaf();
    const scenarios::Wall towards = input.zones.wall(leaf);
    if (!input.before.octree.is_solid(r.leaf.tissue) || towards == scenarios::Wall::opening) return;
    Sample& best = furthest[static_cast<std::size_t>(towards)];
    double beyond = input.zones.distance_mm(leaf);
    for (const IVec3 step : scenarios::k_six_neighbours)
      if (const IVec3 next = leaf + step; input.zones.wall(next) != towards && removed.has(next))
        beyond =
            std::max(beyond, 0.5 * (input.zones.distance_mm(leaf) + input.zones.distance_mm(next)));
    if (beyond > best.deviation_mm) best = {beyond, r.tick, input.zones.centre_mm(leaf)};
  });
  return furthest;
}

/// The hard leaf of the target still standing that lies deepest inside it, from each wall. The cut
/// surface alone does not show it: an island left in the middle covers the places around it.
std::array<Sample, scenarios::k_walls> thickest_left(const GradeInput& input,
                                                     const RemovedMap& removed) {
  const scenarios::ZoneMap& zones = input.zones;
  const Octree& before = input.before.octree;
  std::array<Sample, scenarios::k_walls> thickest{};
  zones.for_each_target_leaf([&](IVec3 leaf) {
    const scenarios::Wall from = zones.wall(leaf);
    if (from == scenarios::Wall::opening || removed.has(leaf)) return;
    Sample& best = thickest[static_cast<std::size_t>(from)];
    const double deviation = zones.distance_mm(leaf);
    if (deviation < best.deviation_mm && before.is_solid(before.tissue(leaf)))
      best = {deviation, -1, zones.centre_mm(leaf)};
  });
  return thickest;
}

std::array<WallMeasures, scenarios::k_walls> wall_measures(
    const GradeInput& input, WallSurface& surface,
    const std::array<Sample, scenarios::k_walls>& furthest,
    const std::array<Sample, scenarios::k_walls>& thickest, double bound_mm) {
  std::array<WallMeasures, scenarios::k_walls> walls;
  for (std::size_t w = 0; w < scenarios::k_walls; ++w) {
    walls[w] = summary(surface.samples[w]);
    walls[w].mean_bound_mm = 0.5 * bound_mm + mean_bound(surface.values[w]);
    walls[w].p95_bound_mm = bound_mm + p95_bound(surface.values[w]);
    // where the whole wall is gone, no surface is left to tell how far it went
    if (furthest[w].deviation_mm > walls[w].max_over_mm) {
      walls[w].max_over_mm = furthest[w].deviation_mm;
      walls[w].worst_over = {furthest[w].tick, furthest[w].place};
    }
    if (walls[w].worst_over.tick >= 0) {
      const scenarios::Zone zone =
          input.zones.zone(input.before.octree.leaf_at(walls[w].worst_over.site_mm));
      walls[w].over_outside = zone == scenarios::Zone::none || zone == scenarios::Zone::protected_;
    }
    // a wall without a cut has no value
    if (walls[w].samples > 0 && -thickest[w].deviation_mm > walls[w].max_under_mm) {
      walls[w].max_under_mm = -thickest[w].deviation_mm;
      walls[w].worst_under = {thickest[w].tick, thickest[w].place};
    }
  }
  return walls;
}

/// Lowest place of the cut surface, mm, anywhere and under the target's leaves; 1e9 without a cut
/// there.
struct Deepest {
  double anywhere_mm = 1e9, in_target_mm = 1e9;
};
Deepest deepest_cut(const GradeInput& input, const RemovedMap& removed, std::int64_t last_tick) {
  Deepest deepest;
  const Octree& after = input.after;
  const scenarios::Facing facing = input.zones.facing();
  const IVec3 inwards = facing.in_tooth({0, 0, -1});
  for_each_removed(input.removed, removed, last_tick, [&](const RemovedAt& r) {
    const IVec3 leaf = r.leaf.leaf(), under = leaf + inwards;
    const double down = after.is_solid(after.tissue(under))
                            ? gone_by(after, leaf) / (gone_by(after, leaf) + stays_by(after, under))
                            : 0.5;
    const double bottom =
        facing.local(input.zones.centre_mm(leaf)).z - down * input.zones.leaf_mm();
    deepest.anywhere_mm = std::min(deepest.anywhere_mm, bottom);
    if (input.zones.zone(leaf) == scenarios::Zone::target)
      deepest.in_target_mm = std::min(deepest.in_target_mm, bottom);
  });
  return deepest;
}

double target_bottom_mm(const scenarios::ZoneMap& zones) {
  const scenarios::Facing facing = zones.facing();
  const IVec3 inwards = facing.in_tooth({0, 0, -1});
  double bottom = zones.top_level_mm();
  zones.for_each_target_leaf([&](IVec3 leaf) {
    const double inside = std::max(-zones.distance_mm(leaf), 0.01 * zones.leaf_mm()),
                 below = zones.distance_mm(leaf + inwards);
    const double down = below < 0 ? 1.0 : inside / (inside + below);
    bottom = std::min(bottom, facing.local(zones.centre_mm(leaf)).z - down * zones.leaf_mm());
  });
  return bottom;
}

void put_outline(ShapeMeasures& m, const Outlines& o, double leaf_mm) {
  m.target_length_mm = o.target.length() * leaf_mm;
  m.target_width_mm = o.target.width() * leaf_mm;
  if (!o.cut.empty()) {
    m.length_mm = o.cut.length() * leaf_mm;
    m.width_mm = o.cut.width() * leaf_mm;
  }
  if (o.common.empty()) return;
  m.length_error_mm = (o.either.length() - o.common.length()) * leaf_mm;
  m.width_error_mm = (o.either.width() - o.common.width()) * leaf_mm;
  m.end_error = {
      {{(o.either.high_x - o.common.high_x) * leaf_mm, (o.cut.high_x - o.target.high_x) * leaf_mm},
       {(o.common.low_x - o.either.low_x) * leaf_mm, (o.target.low_x - o.cut.low_x) * leaf_mm},
       {(o.either.high_y - o.common.high_y) * leaf_mm, (o.cut.high_y - o.target.high_y) * leaf_mm},
       {(o.common.low_y - o.either.low_y) * leaf_mm, (o.target.low_y - o.cut.low_y) * leaf_mm}}};
}

void put_depth(ShapeMeasures& m, const scenarios::ZoneMap& zones, const Deepest& cut,
               bool anything_removed) {
  const double target_bottom = target_bottom_mm(zones), opening = zones.opening_z_mm();
  m.target_depth_mm = opening - target_bottom;
  if (anything_removed) m.depth_mm = opening - cut.anywhere_mm;
  if (cut.in_target_mm < zones.top_level_mm())
    m.depth_error_mm = std::max(target_bottom, std::min(opening, cut.in_target_mm)) -
                       std::min(cut.anywhere_mm, target_bottom);
}

}  // namespace

ShapeMeasures measure_shape(const GradeInput& input, const RemovedMap& removed,
                            std::int64_t last_tick) {
  const double leaf_mm = input.zones.leaf_mm();
  ShapeMeasures m;
  m.facing = input.zones.facing();
  m.bound_mm = leaf_mm + input.surface_bound_mm;  // half a leaf of the target's distance, half a
                                                  // leaf of the cut surface
  WallSurface surface = sample_walls(input, removed, last_tick);
  m.wall = wall_measures(input, surface, furthest_removed(input, removed, last_tick),
                         thickest_left(input, removed), m.bound_mm);
  put_outline(m, cavity_outlines(input, removed, last_tick), leaf_mm);
  put_depth(m, input.zones, deepest_cut(input, removed, last_tick), removed.count() > 0);
  if (surface.across > 0) m.taper_deg = atan_deg(surface.up / surface.across);
  m.taper_bound_deg = taper_bound_deg(surface.sides, leaf_mm);
  return m;
}

}  // namespace cavum::grading
