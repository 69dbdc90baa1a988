#include "grading/measures/cut_surface.h"

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"
#include "grading/measures/bounds.h"
#include "scenarios/zones/relief.h"

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

/// Walls that a place may belong to: its own, and those within a leaf.
unsigned walls_around(const ZoneMap& zones, IVec3 leaf) {
  unsigned walls = 1u << static_cast<unsigned>(zones.wall(leaf));
  for (const IVec3 step : k_six_neighbours) walls |= 1u << static_cast<unsigned>(zones.wall(leaf + step));
  return walls;
}

/// Smallest and largest x and y of an area, in leaves from the tooth's corner.
struct Extent {
  double low_x = 1e9, high_x = -1e9, low_y = 1e9, high_y = -1e9;
  [[nodiscard]] bool empty() const { return high_x < low_x; }
  [[nodiscard]] double length() const { return empty() ? 0.0 : high_x - low_x; }
  [[nodiscard]] double width() const { return empty() ? 0.0 : high_y - low_y; }
};

/// How far inside an area each column's topmost leaf lies (leaves, negative outside), over a box of columns.
struct TopArea {
  int x0, y0, nx, ny;
  std::vector<double> inside;       // x fastest
  std::vector<std::uint8_t> tooth;  // 1 where the column holds tooth
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x);
  }
};

/// The furthest of a border known on parallel lines one apart. Between two lines it may run up to a corner: where the straight
/// continuations from both sides meet, but half a leaf beyond the lines at most.
double furthest(const std::vector<double>& border) {
  constexpr double k_none = -1e9;
  double best = k_none;
  const auto n = border.size();
  for (std::size_t i = 0; i < n; ++i) {
    best = std::max(best, border[i]);
    if (i == 0 || i + 2 >= n || std::min({border[i - 1], border[i], border[i + 1], border[i + 2]}) == k_none) continue;
    const double rise = border[i] - border[i - 1], fall = border[i + 1] - border[i + 2];
    if (!(rise + fall > 0)) continue;
    const double at = (border[i + 1] - border[i] + fall) / (rise + fall);  // from line i on
    if (at > 0 && at < 1) best = std::max(best, std::min(border[i] + rise * at, std::max(border[i], border[i + 1]) + 0.5));
  }
  return best;
}

/// Where the area's border crosses the rows and files of the columns' centres: interpolated along them, at the leaf's face beside the tooth.
Extent extent_of(const TopArea& area) {
  Extent e;
  const auto along = [&](int n, int lines, auto index, double first, double& low, double& high) {
    std::vector<double> lows(static_cast<std::size_t>(lines), -1e9), highs = lows;  // lows with their sign turned
    for (int line = 0; line < lines; ++line)
      for (int i = 0; i < n; ++i) {
        const double v = area.inside[index(i, line)];
        if (area.tooth[index(i, line)] == 0 || !(v > 0)) continue;
        const auto reach = [&](int to) {
          if (to < 0 || to >= n || area.tooth[index(to, line)] == 0) return 0.5;
          const double w = area.inside[index(to, line)];
          return w > 0 ? 0.0 : v / (v - w);
        };
        auto& l = lows[static_cast<std::size_t>(line)];
        auto& h = highs[static_cast<std::size_t>(line)];
        l = std::max(l, -(first + i + 0.5 - reach(i - 1)));
        h = std::max(h, first + i + 0.5 + reach(i + 1));
      }
    low = -furthest(lows);
    high = furthest(highs);
  };
  along(
      area.nx, area.ny, [&](int i, int line) { return area.at(i, line); }, area.x0, e.low_x, e.high_x);
  along(
      area.ny, area.nx, [&](int i, int line) { return area.at(line, i); }, area.y0, e.low_y, e.high_y);
  return e;
}

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
  std::array<Sample, k_walls> furthest{};
  std::array<WallValues, k_walls> values;
  std::vector<WallHeight> sides(4);
  double deepest = 1e9, deepest_in_target = 1e9, up = 0, across = 0;
  // distances in leaves, on the right side of the surface even where a code says otherwise
  const auto gone_by = [&](IVec3 leaf) { return std::max(decode_distance(after.distance_code(leaf)), 0.01); };
  const auto stays_by = [&](IVec3 leaf) { return std::max(-decode_distance(after.distance_code(leaf)), 0.01); };
  IVec3 low{1 << 20, 1 << 20, 0}, high{-1, -1, 0};
  for (const auto& r : input.removed) {
    const IVec3 leaf = r.leaf.leaf();
    if (r.tick > last_tick || removed.tick(leaf) != r.tick) continue;
    const Vec3 centre = zones.centre_mm(leaf);
    low = {std::min(low.x, leaf.x), std::min(low.y, leaf.y), 0};
    high = {std::max(high.x, leaf.x), std::max(high.y, leaf.y), 0};
    const IVec3 under = leaf + IVec3{0, 0, -1};
    const double down = after.is_solid(after.tissue(under)) ? gone_by(leaf) / (gone_by(leaf) + stays_by(under)) : 0.5;
    deepest = std::min(deepest, centre.z - down * leaf_mm);
    if (zones.zone(leaf) == Zone::target) deepest_in_target = std::min(deepest_in_target, centre.z - down * leaf_mm);
    const bool was_solid = before.is_solid(r.leaf.tissue);
    const Wall towards = zones.wall(leaf);
    if (const double beyond = zones.distance_mm(leaf);
        was_solid && towards != Wall::opening && beyond > furthest[static_cast<std::size_t>(towards)].deviation_mm)
      furthest[static_cast<std::size_t>(towards)] = {beyond, r.tick, centre};
    bool beside_solid = false;
    for (const IVec3 step : k_six_neighbours) beside_solid = beside_solid || after.is_solid(after.tissue(leaf + step));
    if (!beside_solid) continue;
    const SurfaceSample s = after.sample(centre, cursor);
    const double steep = length(s.gradient);
    const Vec3 normal = steep > 0.1 ? s.gradient / steep : Vec3{0, 0, 0};  // out of the solid, into the cavity
    const Vec3 place = centre - normal * std::clamp(s.distance_mm, -leaf_mm, leaf_mm);
    const double deviation = zones.distance_mm(place);
    if (!was_solid && deviation > 0) continue;
    const IVec3 where = zones.in_box(before.leaf_at(place)) ? before.leaf_at(place) : leaf;
    const Wall wall = zones.wall(where);
    const auto w = static_cast<std::size_t>(wall);
    const unsigned around = walls_around(zones, where);
    for (std::size_t i = 0; i < k_walls; ++i)
      if ((around >> i & 1u) != 0) (i != w ? values[i].of_others : around == 1u << i ? values[i].sure : values[i].own).push_back(deviation);
    if (wall == Wall::opening) continue;
    samples[w].push_back({deviation, r.tick, place});
    if (wall != Wall::floor && std::fabs(normal.z) < 0.70710678118654752440) {
      sides[w].places += 1;
      sides[w].low_mm = std::min(sides[w].low_mm, place.z);
      sides[w].high_mm = std::max(sides[w].high_mm, place.z);
      up += normal.z;
      across += std::sqrt(normal.x * normal.x + normal.y * normal.y);
    }
  }
  for (std::size_t w = 0; w < k_walls; ++w) {
    m.wall[w] = summary(samples[w]);
    m.wall[w].mean_bound_mm = m.bound_mm + mean_bound(values[w]);
    m.wall[w].p95_bound_mm = m.bound_mm + p95_bound(values[w]);
    // where the whole wall is gone, no surface is left to tell how far it went
    if (furthest[w].deviation_mm <= m.wall[w].max_over_mm) continue;
    m.wall[w].max_over_mm = furthest[w].deviation_mm;
    m.wall[w].worst_over = {furthest[w].tick, furthest[w].place};
  }

  const ColumnMap surface = surface_relief(input.before);
  TopArea cut, target;
  double target_bottom = zones.target_high_mm().z;
  zones.for_each_leaf([&](IVec3 leaf, Zone z) {
    if (z != Zone::target) return;
    low = {std::min(low.x, leaf.x), std::min(low.y, leaf.y), 0};
    high = {std::max(high.x, leaf.x), std::max(high.y, leaf.y), 0};
    const double inside = std::max(-zones.distance_mm(leaf), 0.01 * leaf_mm), below = zones.distance_mm(leaf + IVec3{0, 0, -1});
    const double down = below < 0 ? 1.0 : inside / (inside + below);
    target_bottom = std::min(target_bottom, zones.centre_mm(leaf).z - down * leaf_mm);
  });
  cut.x0 = target.x0 = low.x - 1;
  cut.y0 = target.y0 = low.y - 1;
  cut.nx = target.nx = high.x - low.x + 3;
  cut.ny = target.ny = high.y - low.y + 3;
  TopArea common = cut, either = cut;
  for (int y = 0; y < cut.ny; ++y)
    for (int x = 0; x < cut.nx; ++x) {
      const int top = top_leaf(surface, before, cut.x0 + x, cut.y0 + y);
      const IVec3 leaf{cut.x0 + x, cut.y0 + y, top};
      const double in_cut = top < 0 ? -1.0 : removed.has(leaf) ? gone_by(leaf) : -stays_by(leaf);
      const double in_target = top < 0 ? -1.0 : -zones.distance_mm(leaf) / leaf_mm;
      cut.inside.push_back(in_cut);
      target.inside.push_back(in_target);
      common.inside.push_back(std::min(in_cut, in_target));
      either.inside.push_back(std::max(in_cut, in_target));
      cut.tooth.push_back(top < 0 ? 0 : 1);
    }
  target.tooth = common.tooth = either.tooth = cut.tooth;
  const Extent of_cut = extent_of(cut), of_target = extent_of(target), of_common = extent_of(common), of_either = extent_of(either);
  m.target_length_mm = of_target.length() * leaf_mm;
  m.target_width_mm = of_target.width() * leaf_mm;
  m.target_depth_mm = zones.opening_z_mm() - target_bottom;
  if (!of_cut.empty()) {
    m.length_mm = of_cut.length() * leaf_mm;
    m.width_mm = of_cut.width() * leaf_mm;
  }
  if (!of_common.empty()) {
    m.length_error_mm = (of_either.length() - of_common.length()) * leaf_mm;
    m.width_error_mm = (of_either.width() - of_common.width()) * leaf_mm;
    m.end_error = {{{(of_either.high_x - of_common.high_x) * leaf_mm, (of_cut.high_x - of_target.high_x) * leaf_mm},
                    {(of_common.low_x - of_either.low_x) * leaf_mm, (of_target.low_x - of_cut.low_x) * leaf_mm},
                    {(of_either.high_y - of_common.high_y) * leaf_mm, (of_cut.high_y - of_target.high_y) * leaf_mm},
                    {(of_common.low_y - of_either.low_y) * leaf_mm, (of_target.low_y - of_cut.low_y) * leaf_mm}}};
  }
  if (removed.count() > 0) m.depth_mm = zones.opening_z_mm() - deepest;
  if (deepest_in_target < zones.target_high_mm().z) {
    m.depth_error_mm = std::max(target_bottom, std::min(zones.opening_z_mm(), deepest_in_target)) - std::min(deepest, target_bottom);
  }
  if (across > 0) m.taper_deg = atan_deg(up / across);
  m.taper_bound_deg = taper_bound_deg(sides, leaf_mm);
  return m;
}

}  // namespace cavum
