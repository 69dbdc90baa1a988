#include "scenarios/operators/reach_map.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/tooth/distance_transform.h"

namespace cavum::scenarios {
namespace {

/// True when the head of a bur held as in `map`, with its tip at `tip`, would remove some of the
/// target.
bool cuts_target(const ZoneMap& zones, const Tooth& tooth, const Bur& bur, const ReachMap& map,
                 Vec3 tip) {
  constexpr double k_step_mm = 0.1;
  constexpr double k_s = 0.70710678118654752;
  constexpr Vec3 k_around[] = {{0, 0, 0},       {1, 0, 0},      {k_s, k_s, 0},
                               {0, 1, 0},       {-k_s, k_s, 0}, {-1, 0, 0},
                               {-k_s, -k_s, 0}, {0, -1, 0},     {k_s, -k_s, 0}};
  for (double h = k_step_mm / 2; h < bur.cutting_length_mm; h += k_step_mm)
    for (const Vec3 way : k_around) {
      const Vec3 p = tip + map.tool * (way * bur.profile.radius_mm(h) + Vec3{0, 0, h});
      if (zones.distance_mm(p) < 0 && tooth.octree.tissue_at(p) != k_air) return true;
    }
  return false;
}

/// In the tool's frame, mm.
Bounds box_of_target(const ZoneMap& zones, const Mat3& tool) {
  Bounds box;
  zones.for_each_target_leaf([&](IVec3 leaf) { box.add(tool.transposed(zones.centre_mm(leaf))); });
  const Vec3 half = Vec3{1, 1, 1} * (0.5 * zones.leaf_mm());
  return {box.low - half, box.high + half};
}

/// Highest place of the tooth's lattice in the tool's frame.
double top_of(const Octree& tree, const Mat3& tool) {
  Bounds box;
  const Vec3 size =
      Vec3{double(tree.size().x), double(tree.size().y), double(tree.size().z)} * tree.leaf_mm();
  for (int k = 0; k < 8; ++k)
    box.add(tool.transposed(tree.origin_mm() + Vec3{(k & 1) != 0 ? size.x : 0,
                                                    (k & 2) != 0 ? size.y : 0,
                                                    (k & 4) != 0 ? size.z : 0}));
  return box.high.z;
}

/// The columns over the target and some around it, all unreachable, from the tooth's top down.
ReachMap columns_over(const ZoneMap& zones, const Tooth& tooth) {
  ReachMap map;
  map.tool = rotation(rotation_between({0, 0, 1}, zones.approach()));
  const auto [low, high] = box_of_target(zones, map.tool);
  map.bottom_mm = low.z;
  map.top_mm = high.z;
  const double plan_area = (high.x - low.x) * (high.y - low.y);
  map.step_mm = std::max(plan_area < 16.0 ? 0.05 : 0.1,
                         zones.leaf_mm());  // a small target is worth a closer look
  const int border = static_cast<int>(
      1.2 / map.step_mm);  // columns around the target: tooth that the shank could meet
  map.nx = static_cast<int>((high.x - low.x) / map.step_mm) + 2 + 2 * border;
  map.ny = static_cast<int>((high.y - low.y) / map.step_mm) + 2 + 2 * border;
  map.origin_mm = {low.x - border * map.step_mm, low.y - border * map.step_mm,
                   top_of(tooth.octree, map.tool)};
  map.lowest_mm.assign(static_cast<std::size_t>(map.nx) * static_cast<std::size_t>(map.ny),
                       ReachMap::k_unreachable);
  return map;
}

/// One height of the columns: tooth that must stay, and how far each column lies beyond what may be
/// cut, mm.
struct Slice {
  std::vector<std::uint8_t> forbidden;
  std::vector<double> beyond_mm;
};
Slice slice_at(const ReachMap& map, double height_mm, const ZoneMap& zones, const Tooth& tooth,
               const MarginSpec& margin) {
  Slice slice{std::vector<std::uint8_t>(map.lowest_mm.size()),
              std::vector<double>(map.lowest_mm.size())};
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x) {
      const Vec3 p = map.at(x, y, height_mm);
      const bool bottom = zones.wall(tooth.octree.leaf_at(p)) == Wall::floor;
      const double outside = zones.distance_mm(p) - (bottom ? margin.bottom_mm : margin.sides_mm);
      slice.forbidden[map.index(x, y)] = outside > 0 && tooth.octree.tissue_at(p) != k_air;
      slice.beyond_mm[map.index(x, y)] = outside;
    }
  return slice;
}

/// Appends the free radius around each column of a slice: an upright body of revolution fits where
/// no slice is wider.
void append_free_radii(std::vector<float>& free_mm, const Slice& slice, const ReachMap& map) {
  const auto nearest = nearest_seed({map.nx, map.ny, 1}, slice.forbidden);
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x) {
      const auto n = nearest[map.index(x, y)];
      double room = 100.0;
      if (n >= 0) {
        const double dx = n % map.nx - x, dy = n / map.nx - y;
        // the forbidden column's centre lies `beyond` the target's surface: that much of the way is
        // still free
        room = std::sqrt(dx * dx + dy * dy) * map.step_mm -
               std::min(slice.beyond_mm[static_cast<std::size_t>(n)], map.step_mm);
      }
      free_mm.push_back(static_cast<float>(slice.forbidden[map.index(x, y)] != 0 ? 0.0 : room));
    }
}

/// 1 where there is target to remove, in steps from its bottom to its top.
std::vector<std::uint8_t> target_in_columns(const ReachMap& map, double step_mm,
                                            const ZoneMap& zones, const Tooth& tooth) {
  const auto slices = static_cast<std::size_t>((map.top_mm - map.bottom_mm) / step_mm) + 1;
  std::vector<std::uint8_t> target;
  target.reserve(map.lowest_mm.size() * slices);
  for (std::size_t k = 0; k < slices; ++k)
    for (int y = 0; y < map.ny; ++y)
      for (int x = 0; x < map.nx; ++x) {
        const Vec3 p = map.at(x, y, map.bottom_mm + (static_cast<double>(k) + 0.5) * step_mm);
        target.push_back(zones.distance_mm(p) < 0 && tooth.octree.tissue_at(p) != k_air ? 1 : 0);
      }
  return target;
}

}  // namespace

FreeRoom free_room(const ZoneMap& zones, const Tooth& tooth, const MarginSpec& margin) {
  FreeRoom room;
  room.map = columns_over(zones, tooth);
  room.base_mm =
      room.map.bottom_mm - 0.3 - std::max(0.0, margin.bottom_mm - k_expert_margin.bottom_mm);
  room.slices = static_cast<int>((room.map.origin_mm.z - room.base_mm) / room.step_mm) + 1;
  room.free_mm.reserve(room.map.lowest_mm.size() * static_cast<std::size_t>(room.slices));
  for (int k = 0; k < room.slices; ++k)
    append_free_radii(room.free_mm,
                      slice_at(room.map, room.base_mm + k * room.step_mm, zones, tooth, margin),
                      room.map);
  room.target = target_in_columns(room.map, room.step_mm, zones, tooth);
  return room;
}

ReachMap reach_map(const ZoneMap& zones, const Tooth& tooth, const ContactTool& tool,
                   const MarginSpec& margin) {
  return reach_map(free_room(zones, tooth, margin), zones, tooth, tool);
}

ReachMap reach_map(const FreeRoom& room, const ZoneMap& zones, const Tooth& tooth,
                   const ContactTool& tool) {
  ReachMap map = room.map;
  const double dz = room.step_mm, base = room.base_mm, top_mm = map.top_mm;
  const int slices = room.slices, nx = map.nx;
  const std::size_t columns = map.lowest_mm.size();
  std::vector<double> radius(static_cast<std::size_t>(slices));
  for (std::size_t h = 0; h < radius.size(); ++h)
    radius[h] = tool.bur.profile.radius_mm(static_cast<double>(h) * dz + 0.5 * dz);
  for (std::size_t c = 0; c < columns; ++c) {
    double& lowest = map.lowest_mm[c];
    for (int k = static_cast<int>((top_mm + 0.3 - base) / dz); k >= 0; --k) {
      bool fits = true;
      for (int h = k; h < slices && fits; ++h)
        fits = room.free_mm[static_cast<std::size_t>(h) * columns + c] >=
               radius[static_cast<std::size_t>(h - k)];
      if (!fits) break;
      lowest = base + k * dz;
    }
    const Vec3 tip = map.at(static_cast<int>(c) % nx, static_cast<int>(c) / nx, lowest);
    if (lowest > top_mm || !cuts_target(zones, tooth, tool.bur, map, tip))
      lowest = ReachMap::k_unreachable;  // nothing to do there
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
  const auto off_middle = [percent](int v, int low, int high) {
    return std::abs(2 * v - low - high) * 100.0 > percent * (high - low + 1);
  };
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x)
      if (off_middle(x, low_x, high_x) || off_middle(y, low_y, high_y))
        map.lowest_mm[map.index(x, y)] = ReachMap::k_unreachable;
  return map;
}

namespace {

/// Calls `visit(column, voxel)` for each place of the columns that the coated head reaches from
/// there, at this or any higher place of the tip; voxels are numbered as `room.target`.
template <class Visit>
void for_each_reached(const FreeRoom& room, const ReachMap& map, const ContactTool& tool,
                      const Visit& visit) {
  const double low_z = map.bottom_mm, dz = room.step_mm;
  const auto columns = map.lowest_mm.size();
  const std::size_t slices = room.target.size() / columns;
  for (int y = 0; y < map.ny; ++y)
    for (int x = 0; x < map.nx; ++x) {
      const double tip = map.lowest_mm[map.index(x, y)];
      if (tip >= ReachMap::k_unreachable) continue;
      for (std::size_t k = 0; k < slices; ++k) {
        const double above = low_z + (static_cast<double>(k) + 0.5) * dz - tip;
        if (above < 0) continue;
        const double r =
            tool.bur.profile.radius_mm(std::min(above, tool.bur.cutting_length_mm)) / map.step_mm;
        const int n = static_cast<int>(r);
        for (int dy = -n; dy <= n; ++dy)
          for (int dx = -n; dx <= n; ++dx) {
            if (dx * dx + dy * dy > r * r || x + dx < 0 || y + dy < 0 || x + dx >= map.nx ||
                y + dy >= map.ny)
              continue;
            visit(map.index(x, y), k * columns + map.index(x + dx, y + dy));
          }
      }
    }
}

}  // namespace

ReachMap without_skimming(const FreeRoom& room, ReachMap map, const ContactTool& tool) {
  constexpr double k_skims_mm = 1.0;
  std::vector<float> deepest(room.target.size(), static_cast<float>(ReachMap::k_unreachable));
  for_each_reached(room, map, tool, [&](std::size_t column, std::size_t voxel) {
    deepest[voxel] = std::min(deepest[voxel], static_cast<float>(map.lowest_mm[column]));
  });
  std::vector<std::uint8_t> needed(map.lowest_mm.size());
  for_each_reached(room, map, tool, [&](std::size_t column, std::size_t voxel) {
    if (room.target[voxel] != 0 && map.lowest_mm[column] < deepest[voxel] + k_skims_mm)
      needed[column] = 1;
  });
  for (std::size_t c = 0; c < needed.size(); ++c)
    if (needed[c] == 0) map.lowest_mm[c] = ReachMap::k_unreachable;
  return map;
}

double coverage(const FreeRoom& room, const ReachMap& map, const ContactTool& tool) {
  std::vector<std::uint8_t> covered(room.target.size());
  for_each_reached(room, map, tool, [&](std::size_t, std::size_t voxel) { covered[voxel] = 1; });
  double all = 0, reached = 0;
  for (std::size_t i = 0; i < covered.size(); ++i) {
    all += room.target[i];
    reached += room.target[i] & covered[i];
  }
  return all > 0 ? reached / all : 0;
}

}  // namespace cavum::scenarios
