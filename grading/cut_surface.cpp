#include "grading/cut_surface.h"

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"
#include "scenarios/relief.h"

namespace cavum {

double atan_deg(double t) noexcept {
  const double a = std::fabs(t);
  double x = a > 1 ? 1 / a : a;
  // halved three times: tan(a/2) = t / (1 + sqrt(1 + t²)); then the series needs few terms
  for (int i = 0; i < 3; ++i) x = x / (1 + std::sqrt(1 + x * x));
  const double q = x * x;
  double angle = 8 * x * (1 - q * (1.0 / 3 - q * (1.0 / 5 - q * (1.0 / 7 - q * (1.0 / 9 - q / 11)))));
  if (a > 1) angle = k_pi / 2 - angle;
  return (t < 0 ? -angle : angle) * 180 / k_pi;
}

namespace {

struct Sample {
  double deviation_mm;
  std::int64_t tick;
  Vec3 place;
};

/// Smallest and largest coordinate of a set of columns, in leaf faces.
struct Extent {
  int low_x = 1 << 20, high_x = -1, low_y = 1 << 20, high_y = -1;
  void add(int x, int y) {
    low_x = std::min(low_x, x);
    high_x = std::max(high_x, x + 1);
    low_y = std::min(low_y, y);
    high_y = std::max(high_y, y + 1);
  }
  [[nodiscard]] bool empty() const { return high_x < 0; }
};

WallMeasures summary(std::vector<Sample>& samples) {
  WallMeasures w;
  w.samples = samples.size();
  if (samples.empty()) return w;
  std::stable_sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.deviation_mm < b.deviation_mm; });
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

}  // namespace

ShapeMeasures measure_shape(const GradeInput& input, const RemovedMap& removed, std::int64_t last_tick) {
  const ZoneMap& zones = input.zones;
  const Octree& before = input.before.octree;
  const Octree& after = input.after;
  const double leaf_mm = zones.leaf_mm();
  ShapeMeasures m;
  m.bound_mm = leaf_mm;  // half a leaf of the target's distance, half a leaf of the cut surface
  Octree::Cursor cursor;
  std::array<std::vector<Sample>, k_walls> samples;
  double lowest = 1e9, up = 0, across = 0;
  const ColumnMap surface = surface_relief(input.before);
  Extent cut, target;
  for (const auto& r : input.removed) {
    const IVec3 leaf = r.leaf.leaf();
    if (r.tick > last_tick || removed.tick(leaf) != r.tick) continue;
    const Vec3 centre = zones.centre_mm(leaf);
    if (leaf.z == top_leaf(surface, before, leaf.x, leaf.y)) cut.add(leaf.x, leaf.y);
    lowest = std::min(lowest, centre.z - 0.5 * leaf_mm);
    bool beside_solid = false;
    for (const IVec3 step : k_six_neighbours) beside_solid = beside_solid || after.is_solid(after.tissue(leaf + step));
    if (!beside_solid) continue;
    const SurfaceSample s = after.sample(centre, cursor);
    const double steep = length(s.gradient);
    const Vec3 normal = steep > 0.1 ? s.gradient / steep : Vec3{0, 0, 0};  // out of the solid, into the cavity
    const Vec3 place = centre - normal * std::clamp(s.distance_mm, -leaf_mm, leaf_mm);
    const double deviation = zones.distance_mm(place);
    if (!before.is_solid(r.leaf.tissue) && deviation > 0) continue;
    const Wall wall = zones.wall(zones.in_box(before.leaf_at(place)) ? before.leaf_at(place) : leaf);
    if (wall == Wall::opening) continue;
    samples[static_cast<std::size_t>(wall)].push_back({deviation, r.tick, place});
    if (wall != Wall::floor && std::fabs(normal.z) < 0.70710678118654752440) {
      up += normal.z;
      across += std::sqrt(normal.x * normal.x + normal.y * normal.y);
    }
  }
  for (std::size_t w = 0; w < k_walls; ++w) m.wall[w] = summary(samples[w]);
  zones.for_each_target_leaf([&](IVec3 leaf) {
    if (leaf.z == top_leaf(surface, before, leaf.x, leaf.y)) target.add(leaf.x, leaf.y);
  });
  if (!target.empty()) {
    m.target_length_mm = (target.high_x - target.low_x) * leaf_mm;
    m.target_width_mm = (target.high_y - target.low_y) * leaf_mm;
  }
  m.target_depth_mm = zones.opening_z_mm() - zones.target_low_mm().z;
  if (!cut.empty()) {
    m.length_mm = (cut.high_x - cut.low_x) * leaf_mm;
    m.width_mm = (cut.high_y - cut.low_y) * leaf_mm;
  }
  if (removed.count() > 0) m.depth_mm = zones.opening_z_mm() - lowest;
  if (across > 0) m.taper_deg = atan_deg(up / across);
  return m;
}

}  // namespace cavum
