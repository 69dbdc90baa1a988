#include "scenarios/operators/cut_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/tooth/adjacent.h"
#include "engine/tooth/distance_transform.h"

namespace cavum::scenarios {
namespace {

constexpr double k_outermost = 1e9;     // spacing of loops of which there is to be one alone
constexpr double k_above_mm = 1.0;      // height of the ways through the air over the tooth
constexpr double k_lift_over_mm = 0.6;  // a longer gap between two loops is crossed in the air

/// A set of columns with the distance of each to its edge.
struct Region {
  int nx = 0, ny = 0;
  std::vector<std::uint8_t> inside;
  std::vector<double> depth;  ///< columns to the edge, 0.5 at a border column
  [[nodiscard]] std::size_t index(int x, int y) const noexcept {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] bool has(int x, int y) const noexcept {
    return x >= 0 && y >= 0 && x < nx && y < ny && inside[index(x, y)] != 0;
  }
};

Region region_of(int nx, int ny, const std::vector<std::uint8_t>& inside) {
  Region r{nx, ny, inside, std::vector<double>(inside.size(), 0.0)};
  // padded by a column, so that the map's border counts as an edge
  const int px = nx + 2, py = ny + 2;
  std::vector<std::uint8_t> outside(static_cast<std::size_t>(px) * static_cast<std::size_t>(py), 1);
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x)
      outside[static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(px) +
              static_cast<std::size_t>(x + 1)] = !r.has(x, y);
  const auto nearest = nearest_seed({px, py, 1}, outside);
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) {
      const int n = nearest[static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(px) +
                            static_cast<std::size_t>(x + 1)];
      const double dx = n % px - (x + 1), dy = n / px - (y + 1);
      r.depth[r.index(x, y)] = std::sqrt(dx * dx + dy * dy) - 0.5;
    }
  return r;
}

struct Column {
  int x = 0, y = 0;
  friend bool operator==(const Column&, const Column&) = default;
};

/// Outer border of the component that holds `start` (its lowest, leftmost column), by Moore's
/// neighbour tracing.
std::vector<Column> trace(const Region& r, Column start) {
  static constexpr Column k_around[8] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                         {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  std::vector<Column> loop{start};
  int from = 4;  // came from the left
  Column at = start;
  for (std::size_t guard = 0; guard < 4 * r.inside.size(); ++guard) {
    bool moved = false;
    for (int i = 1; i <= 8; ++i) {
      const int d = (from + i) % 8;
      const Column next{at.x + k_around[d].x, at.y + k_around[d].y};
      if (!r.has(next.x, next.y)) continue;
      at = next;
      from = (d + 4) % 8;
      moved = true;
      break;
    }
    if (!moved || at == start) break;
    loop.push_back(at);
  }
  loop.push_back(start);
  return loop;
}

/// Takes the component of `start` out of the region; returns its columns.
std::vector<Column> take_component(Region& r, Column start) {
  std::vector<Column> todo{start}, taken{start};
  const auto clear = [&r](Column c) { r.inside[r.index(c.x, c.y)] = 0; };
  clear(start);
  while (!todo.empty()) {
    const Column c = todo.back();
    todo.pop_back();
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (r.has(c.x + dx, c.y + dy)) {
          clear({c.x + dx, c.y + dy});
          todo.push_back({c.x + dx, c.y + dy});
          taken.push_back(todo.back());
        }
  }
  return taken;
}

/// Closed loops that cover a region, innermost first. Where an innermost loop runs around a core of
/// more than the spacing, another goes through the core's middle: a pillar would be left.
std::vector<std::vector<Column>> loops_of(const Region& region, double spacing_columns) {
  const double deepest =
      region.depth.empty() ? 0 : *std::max_element(region.depth.begin(), region.depth.end());
  std::vector<std::vector<Column>> loops;
  const auto trace_all = [&loops](Region level, const auto& of_component) {
    for (int y = 0; y < level.ny; ++y)
      for (int x = 0; x < level.nx; ++x)
        if (level.has(x, y)) {
          std::vector<Column> loop = trace(level, {x, y});
          of_component(take_component(level, {x, y}));
          loops.push_back(std::move(loop));
        }
  };
  for (int ring = static_cast<int>(deepest / spacing_columns); ring >= 0; --ring) {
    const double from = ring * spacing_columns;
    Region level = region;
    for (std::size_t i = 0; i < level.inside.size(); ++i)
      level.inside[i] = region.inside[i] != 0 && region.depth[i] >= from;
    trace_all(std::move(level), [&](const std::vector<Column>& columns) {
      double middle = 0;
      for (const Column c : columns)
        middle = std::max(middle, region.depth[region.index(c.x, c.y)]);
      if (middle < from + 0.5 * spacing_columns || middle >= from + spacing_columns)
        return;  // narrow, or it has a next ring
      Region core = region;
      std::fill(core.inside.begin(), core.inside.end(), std::uint8_t{0});
      for (const Column c : columns)
        core.inside[region.index(c.x, c.y)] = region.depth[region.index(c.x, c.y)] >= middle - 1;
      trace_all(std::move(core), [](const std::vector<Column>&) {});
    });
  }
  return loops;
}

double distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 ab = b - a;
  const double n = dot(ab, ab);
  const double t = n > 0 ? std::clamp(dot(p - a, ab) / n, 0.0, 1.0) : 0.0;
  return length(p - a - ab * t);
}

/// Douglas-Peucker: keeps the points that stand off the line between their neighbours by more than
/// `tolerance`.
void simplify(const std::vector<Vec3>& line, std::size_t first, std::size_t last, double tolerance,
              std::vector<Vec3>& out) {
  double furthest = tolerance;
  std::size_t split = first;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double d = distance_to_segment(line[i], line[first], line[last]);
    if (d > furthest) {
      furthest = d;
      split = i;
    }
  }
  if (split == first) {
    out.push_back(line[last]);
    return;
  }
  simplify(line, first, split, tolerance, out);
  simplify(line, split, last, tolerance, out);
}

/// A loop as places of the tip, simplified to `tolerance_mm`, at the layer's height or higher where
/// the column ends.
std::vector<Vec3> corners(const ReachMap& map, const std::vector<Column>& loop, double layer_z,
                          double tolerance_mm) {
  std::vector<Vec3> line;
  for (const auto& c : loop)
    line.push_back(map.at(c.x, c.y, std::max(layer_z, map.lowest_mm[map.index(c.x, c.y)])));
  if (line.size() < 3) return line;
  std::vector<Vec3> out{line.front()};
  const std::size_t half = line.size() / 2;  // a closed loop has no chord: cut it in two
  simplify(line, 0, half, tolerance_mm, out);
  simplify(line, half, line.size() - 1, tolerance_mm, out);
  return out;
}

/// Builds the list of waypoints, lifting between distant places and marking those close to a void
/// tissue.
class Way {
 public:
  Way(const Tooth& tooth, const ReachMap& map)
      : tooth_(tooth), tool_(map.tool), air_z_(map.origin_mm.z + k_above_mm) {}

  void follow(const std::vector<Vec3>& loop) {
    if (loop.empty()) return;
    if (points_.empty() || length(points_.back().tip_mm - loop.front()) > k_lift_over_mm) {
      lift();
      points_.push_back({in_air(loop.front()), false, false});
    }
    for (const auto& p : loop) points_.push_back({p, true, near_void(p)});
  }
  void lift() {
    if (points_.empty()) return;
    const Vec3 p = points_.back().tip_mm;
    if (tool_.transposed(p).z < air_z_) points_.push_back({in_air(p), false, false});
  }
  [[nodiscard]] std::vector<Waypoint> take() { return std::move(points_); }

 private:
  /// The place above `p` where the bur is clear of the tooth.
  [[nodiscard]] Vec3 in_air(Vec3 p) const {
    const Vec3 l = tool_.transposed(p);
    return tool_ * Vec3{l.x, l.y, air_z_};
  }
  [[nodiscard]] bool near_void(Vec3 tip) const {
    for (double below = -0.2; below <= 0.8; below += 0.1) {
      const auto t = tooth_.octree.tissue_at(tip - tool_ * Vec3{0, 0, below});
      if (t != k_air && !tooth_.octree.is_solid(t)) return true;
    }
    return false;
  }
  const Tooth& tooth_;
  Mat3 tool_;
  double air_z_;
  std::vector<Waypoint> points_;
};

}  // namespace

std::vector<Waypoint> plan_cut(const ReachMap& map, const Tooth& tooth,
                               const PlanOptions& options) {
  double deepest = ReachMap::k_unreachable;
  for (const double z : map.lowest_mm) deepest = std::min(deepest, z);
  if (deepest == ReachMap::k_unreachable) return {};
  const double top = map.top_mm;
  Way way(tooth, map);
  std::vector<std::uint8_t> inside(map.lowest_mm.size());
  const int layers = std::max(1, static_cast<int>((top - deepest) / options.layer_mm + 0.999));
  for (int i = 1; i <= layers; ++i) {
    const double z = top - (top - deepest) * i / layers;
    // columns that end higher join with the height they have, so that each layer keeps its full
    // outline
    const double reach_z = z + options.layer_mm;
    for (std::size_t c = 0; c < inside.size(); ++c) inside[c] = map.lowest_mm[c] < reach_z;
    const Region region = region_of(map.nx, map.ny, inside);
    const auto loops = loops_of(region, options.spacing_mm / map.step_mm);
    for (const auto& loop : loops) way.follow(corners(map, loop, z, options.tolerance_mm));
    // once more around the wall: what the first pass left would hold up the neck of the bur further
    // down
    if (!loops.empty()) way.follow(corners(map, loops.back(), z, options.tolerance_mm));
  }
  // the floor pass follows the lowest reach of every column
  for (std::size_t c = 0; c < inside.size(); ++c)
    inside[c] = map.lowest_mm[c] < ReachMap::k_unreachable;
  const Region all = region_of(map.nx, map.ny, inside);
  for (const auto& loop : loops_of(all, options.finish_spacing_mm / map.step_mm))
    way.follow(corners(map, loop, deepest, options.tolerance_mm));
  // before a neighbour a wall of the target bulges inwards with it: at each height once along all
  // that reaches so deep
  if (has_adjacent(tooth))
    for (double z = deepest; z < top; z += options.layer_mm / 3) {
      for (std::size_t c = 0; c < inside.size(); ++c)
        inside[c] = map.lowest_mm[c] <= z + 0.5 * map.step_mm;
      for (const auto& loop : loops_of(region_of(map.nx, map.ny, inside), k_outermost))
        way.follow(corners(map, loop, z, options.tolerance_mm));
    }
  way.lift();
  return way.take();
}

std::vector<Waypoint> plan_pilot(const ReachMap& map, const Tooth& tooth, double head_radius_mm,
                                 const std::vector<std::string>& aims) {
  constexpr double k_into_mm = 0.35,
                   k_light_mm =
                       0.8;  // it goes on that far when it gives way; pressed lightly from there on
  constexpr double k_none = -1e9,
                   k_falls_share =
                       0.7;  // of the head's radius: with so much of it over the aim it falls in
  const double leaf = tooth.octree.leaf_mm();
  std::array<bool, 256> is_aim{};
  for (const auto& t : tooth.tissues)
    is_aim[t.id] = t.id != k_air && std::find(aims.begin(), aims.end(), t.name) != aims.end();
  std::vector<double> roof(map.lowest_mm.size(),
                           k_none);  // height of the aim's first place from above
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x)
      for (double z = map.top_mm; z > map.bottom_mm && roof[map.index(x, y)] == k_none; z -= leaf)
        if (is_aim[tooth.octree.tissue_at(map.at(x, y, z))]) roof[map.index(x, y)] = z;
  double falls_at = 0, to_z = 0, least_spread = 1e9;
  int at_x = -1, at_y = -1;
  const int around = static_cast<int>(k_falls_share * head_radius_mm / map.step_mm);
  for (int y = around; y + around < map.ny; ++y)
    for (int x = around; x + around < map.nx; ++x) {
      double high = k_none, low = map.top_mm;
      for (int dy = -around; dy <= around; ++dy)
        for (int dx = -around; dx <= around; ++dx)
          if (dx * dx + dy * dy <= around * around) {
            high = std::max(high, roof[map.index(x + dx, y + dy)]);
            low = std::min(low, roof[map.index(x + dx, y + dy)]);
          }
      const double lowest = map.lowest_mm[map.index(x, y)];
      if (low == k_none || lowest >= low - leaf ||
          high - low > least_spread - (low > falls_at ? 0.0 : leaf))
        continue;
      least_spread = high - low, falls_at = low, to_z = std::max(lowest, low - k_into_mm), at_x = x,
      at_y = y;
    }
  if (at_x < 0) return {};
  const Vec3 air = map.at(at_x, at_y, map.origin_mm.z + k_above_mm);
  return {{air, false, false},
          {map.at(at_x, at_y, falls_at + k_light_mm), true, false},
          {map.at(at_x, at_y, to_z), true, true},
          {air, false, false}};
}

std::vector<Waypoint> plan_perforation(const ZoneMap& zones, const Tooth& tooth,
                                       const ReachMap& map, std::uint8_t fault) {
  constexpr double k_furthest_mm = 6.0, k_beyond_mm = 0.8;
  const double leaf = zones.leaf_mm();
  double shortest = k_furthest_mm;
  Vec3 air, from, to;
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x) {
      const double z = map.lowest_mm[map.index(x, y)];
      if (z >= ReachMap::k_unreachable) continue;
      for (double down = 0; down < shortest; down += leaf) {
        if (tooth.octree.tissue_at(map.at(x, y, z - down)) != fault) continue;
        shortest = down;
        air = map.at(x, y, map.origin_mm.z + k_above_mm);
        from = map.at(x, y, z);
        to = map.at(x, y, z - down - k_beyond_mm);
        break;
      }
    }
  if (shortest >= k_furthest_mm) return {};
  return {{air, false, false}, {from, true, false}, {to, true, false}, {air, false, false}};
}

}  // namespace cavum::scenarios
