#include "scenarios/candidates/cut_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/tooth/distance_transform.h"

namespace cavum {
namespace {

constexpr double k_above_mm = 1.0;      // height of the ways through the air over the tooth
constexpr double k_lift_over_mm = 0.6;  // a longer gap between two loops is crossed in the air

/// A set of columns with the distance of each to its edge.
struct Region {
  int nx = 0, ny = 0;
  std::vector<std::uint8_t> inside;
  std::vector<double> depth;  ///< columns to the edge, 0.5 at a border column
  [[nodiscard]] bool has(int x, int y) const noexcept {
    return x >= 0 && y >= 0 && x < nx && y < ny &&
           inside[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x)] != 0;
  }
};

Region region_of(int nx, int ny, const std::vector<std::uint8_t>& inside) {
  Region r{nx, ny, inside, std::vector<double>(inside.size(), 0.0)};
  // padded by a column, so that the map's border counts as an edge
  const int px = nx + 2, py = ny + 2;
  std::vector<std::uint8_t> outside(static_cast<std::size_t>(px) * static_cast<std::size_t>(py), 1);
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x)
      outside[static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(px) + static_cast<std::size_t>(x + 1)] = !r.has(x, y);
  const auto nearest = nearest_seed({px, py, 1}, outside);
  for (int y = 0; y < ny; ++y)
    for (int x = 0; x < nx; ++x) {
      const int n = nearest[static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(px) + static_cast<std::size_t>(x + 1)];
      const double dx = n % px - (x + 1), dy = n / px - (y + 1);
      r.depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x)] = std::sqrt(dx * dx + dy * dy) - 0.5;
    }
  return r;
}

struct Column {
  int x = 0, y = 0;
  friend bool operator==(const Column&, const Column&) = default;
};

/// Outer border of the component that holds `start` (its lowest, leftmost column), by Moore's neighbour tracing.
std::vector<Column> trace(const Region& r, Column start) {
  static constexpr Column k_around[8] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
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

/// Marks the component of `start` as done.
void erase_component(Region& r, Column start) {
  std::vector<Column> todo{start};
  const auto clear = [&r](Column c) { r.inside[static_cast<std::size_t>(c.y) * static_cast<std::size_t>(r.nx) + static_cast<std::size_t>(c.x)] = 0; };
  clear(start);
  while (!todo.empty()) {
    const Column c = todo.back();
    todo.pop_back();
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (r.has(c.x + dx, c.y + dy)) {
          clear({c.x + dx, c.y + dy});
          todo.push_back({c.x + dx, c.y + dy});
        }
  }
}

/// Closed loops that cover a region, innermost first.
std::vector<std::vector<Column>> loops_of(const Region& region, double spacing_columns) {
  const double deepest = region.depth.empty() ? 0 : *std::max_element(region.depth.begin(), region.depth.end());
  std::vector<std::vector<Column>> loops;
  for (int ring = static_cast<int>(deepest / spacing_columns); ring >= 0; --ring) {
    Region level = region;
    for (std::size_t i = 0; i < level.inside.size(); ++i) level.inside[i] = region.inside[i] != 0 && region.depth[i] >= ring * spacing_columns;
    for (int y = 0; y < level.ny; ++y)
      for (int x = 0; x < level.nx; ++x)
        if (level.has(x, y)) {
          loops.push_back(trace(level, {x, y}));
          erase_component(level, {x, y});
        }
  }
  return loops;
}

double distance_to_segment(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 ab = b - a;
  const double n = dot(ab, ab);
  const double t = n > 0 ? std::clamp(dot(p - a, ab) / n, 0.0, 1.0) : 0.0;
  return length(p - a - ab * t);
}

/// Douglas-Peucker: keeps the points that stand off the line between their neighbours by more than `tolerance`.
void simplify(const std::vector<Vec3>& line, std::size_t first, std::size_t last, double tolerance, std::vector<Vec3>& out) {
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

/// A loop as places of the tip, simplified to `tolerance_mm`, at the layer's height or higher where the column ends.
std::vector<Vec3> corners(const ReachMap& map, const std::vector<Column>& loop, double layer_z, double tolerance_mm) {
  std::vector<Vec3> line;
  for (const auto& c : loop) line.push_back(map.at(c.x, c.y, std::max(layer_z, map.lowest_mm[map.index(c.x, c.y)])));
  if (line.size() < 3) return line;
  std::vector<Vec3> out{line.front()};
  const std::size_t half = line.size() / 2;  // a closed loop has no chord: cut it in two
  simplify(line, 0, half, tolerance_mm, out);
  simplify(line, half, line.size() - 1, tolerance_mm, out);
  return out;
}

/// Builds the list of waypoints, lifting between distant places and marking those close to a void tissue.
class Way {
 public:
  Way(const Tooth& tooth, const ReachMap& map) : tooth_(tooth), tool_(map.tool), air_z_(map.origin_mm.z + k_above_mm) {}

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
  /// The place above `p` where the point is clear of the tooth.
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

/// True when the head of a point held as in `map`, with its tip at `tip`, would remove some of the target.
bool cuts_target(const ZoneMap& zones, const Tooth& tooth, const DiamondPoint& point, const ReachMap& map, Vec3 tip) {
  constexpr double k_step_mm = 0.1;
  constexpr double k_s = 0.70710678118654752;
  constexpr Vec3 k_around[] = {{0, 0, 0},  {1, 0, 0},       {k_s, k_s, 0}, {0, 1, 0},     {-k_s, k_s, 0},
                               {-1, 0, 0}, {-k_s, -k_s, 0}, {0, -1, 0},    {k_s, -k_s, 0}};
  for (double h = k_step_mm / 2; h < point.cutting_length_mm; h += k_step_mm)
    for (const Vec3 way : k_around) {
      const Vec3 p = tip + map.tool * (way * point.profile.radius_mm(h) + Vec3{0, 0, h});
      if (zones.distance_mm(p) < 0 && tooth.octree.tissue_at(p) != k_air) return true;
    }
  return false;
}

/// A box in the tool's frame, mm.
struct Box {
  Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  void hold(Vec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
};

Box box_of_target(const ZoneMap& zones, const Mat3& tool) {
  Box box;
  zones.for_each_target_leaf([&](IVec3 leaf) { box.hold(tool.transposed(zones.centre_mm(leaf))); });
  const Vec3 half = Vec3{1, 1, 1} * (0.5 * zones.leaf_mm());
  return {box.low - half, box.high + half};
}

/// Highest place of the tooth's lattice in the tool's frame.
double top_of(const Octree& tree, const Mat3& tool) {
  Box box;
  const Vec3 size = Vec3{double(tree.size().x), double(tree.size().y), double(tree.size().z)} * tree.leaf_mm();
  for (int k = 0; k < 8; ++k)
    box.hold(tool.transposed(tree.origin_mm() + Vec3{(k & 1) != 0 ? size.x : 0, (k & 2) != 0 ? size.y : 0, (k & 4) != 0 ? size.z : 0}));
  return box.high.z;
}

}  // namespace

FreeRoom free_room(const ZoneMap& zones, const Tooth& tooth, const MarginSpec& margin) {
  FreeRoom room_above;
  ReachMap& map = room_above.map;
  map.tool = rotation(rotation_between({0, 0, 1}, zones.approach()));
  const auto [low, high] = box_of_target(zones, map.tool);
  map.bottom_mm = low.z;
  map.top_mm = high.z;
  const double plan_area = (high.x - low.x) * (high.y - low.y);
  map.step_mm = std::max(plan_area < 16.0 ? 0.05 : 0.1, zones.leaf_mm());  // a small target is worth a closer look
  const int border = static_cast<int>(1.2 / map.step_mm);                  // columns around the target: tooth that the shank could meet
  const int nx = static_cast<int>((high.x - low.x) / map.step_mm) + 2 + 2 * border,
            ny = static_cast<int>((high.y - low.y) / map.step_mm) + 2 + 2 * border;
  const double top = top_of(tooth.octree, map.tool);
  map.nx = nx;
  map.ny = ny;
  map.origin_mm = {low.x - border * map.step_mm, low.y - border * map.step_mm, top};
  const auto columns = static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
  map.lowest_mm.assign(columns, ReachMap::k_unreachable);

  // For every height the free radius around each column: an upright body of revolution fits where no slice is wider.
  const double dz = 0.1, base = low.z - 0.3 - std::max(0.0, margin.bottom_mm - k_expert_margin.bottom_mm);
  const int slices = static_cast<int>((top - base) / dz) + 1;
  std::vector<float>& free_mm = room_above.free_mm;
  free_mm.resize(columns * static_cast<std::size_t>(slices));
  std::vector<std::uint8_t> forbidden(columns);
  std::vector<double> beyond(columns);
  for (int k = 0; k < slices; ++k) {
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        const Vec3 p = map.at(x, y, base + k * dz);
        const bool bottom = zones.wall(tooth.octree.leaf_at(p)) == Wall::floor;
        const double outside = zones.distance_mm(p) - (bottom ? margin.bottom_mm : margin.sides_mm);
        forbidden[map.index(x, y)] = outside > 0 && tooth.octree.tissue_at(p) != k_air;
        beyond[map.index(x, y)] = outside;
      }
    const auto nearest = nearest_seed({nx, ny, 1}, forbidden);
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        const auto n = nearest[map.index(x, y)];
        double room = 100.0;
        if (n >= 0) {
          const double dx = n % nx - x, dy = n / nx - y;
          // the forbidden column's centre lies `beyond` the target's surface: that much of the way is still free
          room = std::sqrt(dx * dx + dy * dy) * map.step_mm - std::min(beyond[static_cast<std::size_t>(n)], map.step_mm);
        }
        free_mm[static_cast<std::size_t>(k) * columns + map.index(x, y)] = static_cast<float>(forbidden[map.index(x, y)] != 0 ? 0.0 : room);
      }
  }
  const auto target_slices = static_cast<std::size_t>((high.z - low.z) / dz) + 1;
  room_above.target.reserve(columns * target_slices);
  for (std::size_t k = 0; k < target_slices; ++k)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) {
        const Vec3 p = map.at(x, y, low.z + (static_cast<double>(k) + 0.5) * dz);
        room_above.target.push_back(zones.distance_mm(p) < 0 && tooth.octree.tissue_at(p) != k_air ? 1 : 0);
      }
  room_above.base_mm = base;
  room_above.step_mm = dz;
  room_above.slices = slices;
  return room_above;
}

ReachMap reach_map(const ZoneMap& zones, const Tooth& tooth, const ContactTool& tool, const MarginSpec& margin) {
  return reach_map(free_room(zones, tooth, margin), zones, tooth, tool);
}

ReachMap reach_map(const FreeRoom& room, const ZoneMap& zones, const Tooth& tooth, const ContactTool& tool) {
  ReachMap map = room.map;
  const double dz = room.step_mm, base = room.base_mm, top_mm = map.top_mm;
  const int slices = room.slices, nx = map.nx;
  const std::size_t columns = map.lowest_mm.size();
  std::vector<double> radius(static_cast<std::size_t>(slices));
  for (std::size_t h = 0; h < radius.size(); ++h) radius[h] = tool.point.profile.radius_mm(static_cast<double>(h) * dz + 0.5 * dz);
  for (std::size_t c = 0; c < columns; ++c) {
    double& lowest = map.lowest_mm[c];
    for (int k = static_cast<int>((top_mm + 0.3 - base) / dz); k >= 0; --k) {
      bool fits = true;
      for (int h = k; h < slices && fits; ++h)
        fits = room.free_mm[static_cast<std::size_t>(h) * columns + c] >= radius[static_cast<std::size_t>(h - k)];
      if (!fits) break;
      lowest = base + k * dz;
    }
    const Vec3 tip = map.at(static_cast<int>(c) % nx, static_cast<int>(c) / nx, lowest);
    if (lowest > top_mm || !cuts_target(zones, tooth, tool.point, map, tip)) lowest = ReachMap::k_unreachable;  // nothing to do there
  }
  return map;
}

ReachMap middle_of(ReachMap map, double percent) {
  int low_x = map.nx, high_x = -1, low_y = map.ny, high_y = -1;
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x) {
      if (map.lowest_mm[map.index(x, y)] >= ReachMap::k_unreachable) continue;
      low_x = std::min(low_x, x);
      high_x = std::max(high_x, x);
      low_y = std::min(low_y, y);
      high_y = std::max(high_y, y);
    }
  const auto off_middle = [percent](int v, int low, int high) { return std::abs(2 * v - low - high) * 100.0 > percent * (high - low + 1); };
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x)
      if (off_middle(x, low_x, high_x) || off_middle(y, low_y, high_y)) map.lowest_mm[map.index(x, y)] = ReachMap::k_unreachable;
  return map;
}

double coverage(const FreeRoom& room, const ReachMap& map, const ContactTool& tool) {
  const double low_z = map.bottom_mm, dz = room.step_mm;
  const auto columns = map.lowest_mm.size();
  const std::size_t slices = room.target.size() / columns;
  std::vector<std::uint8_t> covered(columns * slices);
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x) {
      const double tip = map.lowest_mm[map.index(x, y)];
      if (tip >= ReachMap::k_unreachable) continue;
      for (std::size_t k = 0; k < slices; ++k) {
        const double above = low_z + (static_cast<double>(k) + 0.5) * dz - tip;
        if (above < 0) continue;
        // what the coated head reaches there, at this or any higher place of the tip
        const double r = tool.point.profile.radius_mm(std::min(above, tool.point.cutting_length_mm)) / map.step_mm;
        const int n = static_cast<int>(r);
        for (int dy = -n; dy <= n; ++dy)
          for (int dx = -n; dx <= n; ++dx) {
            if (dx * dx + dy * dy > r * r || x + dx < 0 || y + dy < 0 || x + dx >= map.nx || y + dy >= map.ny) continue;
            covered[k * columns + map.index(x + dx, y + dy)] = 1;
          }
      }
    }
  double all = 0, reached = 0;
  for (std::size_t i = 0; i < covered.size(); ++i) {
    all += room.target[i];
    reached += room.target[i] & covered[i];
  }
  return all > 0 ? reached / all : 0;
}

std::vector<Waypoint> plan_cut(const ReachMap& map, const Tooth& tooth, const PlanOptions& options) {
  double deepest = ReachMap::k_unreachable;
  for (const double z : map.lowest_mm) deepest = std::min(deepest, z);
  if (deepest == ReachMap::k_unreachable) return {};
  const double top = map.top_mm;
  Way way(tooth, map);
  std::vector<std::uint8_t> inside(map.lowest_mm.size());
  const int layers = std::max(1, static_cast<int>((top - deepest) / options.layer_mm + 0.999));
  for (int i = 1; i <= layers; ++i) {
    const double z = top - (top - deepest) * i / layers;
    // columns that end higher join with the height they have, so that each layer keeps its full outline
    const double reach_z = z + options.layer_mm;
    for (std::size_t c = 0; c < inside.size(); ++c) inside[c] = map.lowest_mm[c] < reach_z;
    const Region region = region_of(map.nx, map.ny, inside);
    const auto loops = loops_of(region, options.spacing_mm / map.step_mm);
    for (const auto& loop : loops) way.follow(corners(map, loop, z, options.tolerance_mm));
    // once more around the wall: what the first pass left would hold up the neck of the point further down
    if (!loops.empty()) way.follow(corners(map, loops.back(), z, options.tolerance_mm));
  }
  // the floor pass follows the lowest reach of every column
  for (std::size_t c = 0; c < inside.size(); ++c) inside[c] = map.lowest_mm[c] < ReachMap::k_unreachable;
  const Region all = region_of(map.nx, map.ny, inside);
  for (const auto& loop : loops_of(all, options.finish_spacing_mm / map.step_mm)) way.follow(corners(map, loop, deepest, options.tolerance_mm));
  way.lift();
  return way.take();
}

std::vector<Waypoint> plan_perforation(const ZoneMap& zones, const Tooth& tooth, const ReachMap& map, std::uint8_t fault) {
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

}  // namespace cavum
