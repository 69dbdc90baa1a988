#include "grading/measures/adjacent.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/tooth/octree_edit.h"
#include "grading/measures/leaf_faces.h"
#include "grading/measures/removed_map.h"
#include "grading/measures/site_blocks.h"
#include "grading/measures/solid_surface.h"

namespace cavum::grading {
namespace {

constexpr double k_sight_mm =
    3.0;  // around what was cut: a surface further away is not the nearest

/// The neighbours' surface as it was, near a box.
SiteBlocks surface_of(const Octree& neighbours, Vec3 low_mm, Vec3 high_mm) {
  SiteBlocks surface;
  Octree::Cursor cursor;
  const IVec3 low = neighbours.leaf_at(low_mm), high = neighbours.leaf_at(high_mm);
  const auto within = [&](IVec3 l) {
    return l.x >= low.x && l.y >= low.y && l.z >= low.z && l.x <= high.x && l.y <= high.y &&
           l.z <= high.z;
  };
  const auto outside_solid = [&](IVec3 leaf) {
    return std::any_of(
        std::begin(scenarios::k_six_neighbours), std::end(scenarios::k_six_neighbours),
        [&](IVec3 step) { return !neighbours.is_solid(neighbours.tissue(leaf + step)); });
  };
  neighbours.for_each_cube([&](IVec3 at, int edge, std::uint8_t tissue) {
    if (!neighbours.is_solid(tissue)) return;
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x)
          if (const IVec3 leaf = at + IVec3{x, y, z}; within(leaf) && outside_solid(leaf))
            surface.add(leaf, surface_by(neighbours, leaf, cursor).at_mm);
  });
  return surface;
}

/// Distance to the neighbours' surface as it was, mm.
class ToSurface {
 public:
  ToSurface(const Octree& neighbours, const SiteBlocks& surface)
      : neighbours_(neighbours), surface_(surface) {}
  /// `place` gets the nearest one. Within a leaf the octree's own distance is finer; further on a
  /// coarse tooth's says nothing.
  double mm(Vec3 from, Vec3& place) {
    double nearest = 1e9;
    surface_.nearer(from, nearest, place);
    const double near = std::fabs(neighbours_.sample(from, cursor_).distance_mm);
    return near < 0.9 * neighbours_.leaf_mm() ? near : nearest;
  }

 private:
  const Octree& neighbours_;
  const SiteBlocks& surface_;
  Octree::Cursor cursor_;
};

struct NickFace {
  IVec3 from, to;
};

void measure_nick(const GradeInput& input, std::span<const RemovedAt> nick, AdjacentMeasures& m) {
  const Octree& neighbours = input.beside->apart.neighbours;
  const double leaf = neighbours.leaf_mm();
  m.nick_depth_bound_mm = leaf;
  if (nick.empty()) return;
  Bounds box;
  for (const auto& r : nick) box.add(neighbours.centre_mm(r.leaf.leaf()));
  const Vec3 sight{k_sight_mm, k_sight_mm, k_sight_mm};
  const SiteBlocks surface = surface_of(neighbours, box.low - sight, box.high + sight);
  ToSurface to(neighbours, surface);
  Octree::Cursor was, is;
  std::vector<NickFace> faces;
  for (const auto& r : nick) {
    const IVec3 at = r.leaf.leaf();
    const Vec3 floor = beside_solid(input.beside->after, at, is)
                           ? surface_by(input.beside->after, at, is).at_mm
                           : neighbours.centre_mm(at);
    Vec3 nearest;
    if (const double deep = to.mm(floor, nearest); deep > m.nick_depth_mm) {
      m.nick_depth_mm = deep;
      m.deepest = {r.tick, floor};
    }
    const Vec3 normal = normalized(neighbours.sample(neighbours.centre_mm(at), was).gradient);
    for (const IVec3 step : scenarios::k_six_neighbours) {
      if (neighbours.is_solid(neighbours.tissue(at + step))) continue;
      faces.push_back({at, at + step});
      m.nick_area_mm2 +=
          leaf * leaf * std::fabs(normal.x * step.x + normal.y * step.y + normal.z * step.z);
    }
  }
  m.nick_area_bound_mm2 = 0.5 * leaf * leaf * k_stairs * static_cast<double>(rim_edges(faces));
}

/// Rows of leaves along x on one side of the tooth, by y and z.
class ContactRows {
 public:
  ContactRows(const GradeInput& input, int side)
      : was_(input.before.octree),
        is_(input.after),
        neighbours_(input.beside->apart.neighbours),
        zones_(input.zones),
        side_(side),
        low_(input.zones.low() - IVec3{0, 1, 1}),
        ny_(input.zones.size().y + 2),
        nz_(input.zones.size().z + 2),
        shell_(static_cast<int>(k_shell_mm / input.zones.leaf_mm() + 0.5)) {
    rows_.resize(static_cast<std::size_t>(ny_) * static_cast<std::size_t>(nz_));
    for (int z = 0; z < nz_; ++z)
      for (int y = 0; y < ny_; ++y) read(y, z);
  }
  /// Calls `visit(leaf)` for the outermost leaf left in every row that counts.
  template <class Visit>
  void for_each_left(const Visit& visit) const {
    bool any = false;
    for (const Row& r : rows_) any = any || r.asked;
    if (!any) return;
    for (int z = 0; z < nz_; ++z)
      for (int y = 0; y < ny_; ++y) {
        const Row& r = row(y, z);
        if (r.left >= 0 && (r.asked || (!r.opened && adjacent_opened(y, z))))
          visit(IVec3{r.left, low_.y + y, low_.z + z});
      }
  }

 private:
  struct Row {
    bool asked = false, opened = false;
    int left = -1;  // x of the outermost leaf left, -1 without
  };
  [[nodiscard]] const Row& row(int y, int z) const {
    return rows_[static_cast<std::size_t>(z) * static_cast<std::size_t>(ny_) +
                 static_cast<std::size_t>(y)];
  }
  [[nodiscard]] bool opened(int y, int z) const {
    return y >= 0 && z >= 0 && y < ny_ && z < nz_ && row(y, z).opened;
  }
  [[nodiscard]] bool adjacent_opened(int y, int z) const {
    return opened(y - 1, z) || opened(y + 1, z) || opened(y, z - 1) || opened(y, z + 1);
  }
  [[nodiscard]] bool solid(const Octree& tree, int x, int y, int z) const {
    return tree.is_solid(tree.tissue({x, low_.y + y, low_.z + z}));
  }

  /// A neighbour's surface lies before that place of the tooth's, no further than an embrasure is
  /// wide.
  [[nodiscard]] bool faces_neighbour(int x, int y, int z) const {
    constexpr double k_embrasure_mm = 1.0;
    for (int i = 1; i * zones_.leaf_mm() <= k_embrasure_mm; ++i)
      if (solid(neighbours_, x + side_ * i, y, z)) return true;
    return false;
  }
  void read(int y, int z) {
    Row& r = rows_[static_cast<std::size_t>(z) * static_cast<std::size_t>(ny_) +
                   static_cast<std::size_t>(y)];
    const int n = was_.size().x, outside = side_ > 0 ? n - 1 : 0;
    int x = outside;
    while (x >= 0 && x < n && !solid(was_, x, y, z)) x -= side_;
    if (x < 0 || x >= n) return;
    const int surface = x;
    if (!faces_neighbour(surface, y, z)) return;
    for (int i = 0; i <= shell_; ++i)
      r.asked = r.asked || zones_.zone({surface - side_ * i, low_.y + y, low_.z + z}) ==
                               scenarios::Zone::target;
    r.opened = !solid(is_, surface, y, z);
    for (; x >= 0 && x < n; x -= side_) {
      if (!solid(is_, x, y, z)) continue;
      int end = x;  // of what is left in one piece
      while (end >= 0 && end < n && solid(is_, end, y, z) && std::abs(x - end) <= shell_)
        end -= side_;
      const bool cavity_behind =
          end >= 0 && end < n && !solid(is_, end, y, z) && solid(was_, end, y, z);
      if (!cavity_behind || std::abs(x - end) > shell_) break;
      r.opened = true;
      x = end;
    }
    if (x >= 0 && x < n) r.left = x;
  }

  const Octree &was_, &is_, &neighbours_;
  const scenarios::ZoneMap& zones_;
  int side_;
  IVec3 low_;
  int ny_, nz_, shell_;
  std::vector<Row> rows_;
};

/// Whether a neighbour stands on a side of the tooth.
bool stands_on(const AdjacentInput& beside, int side) {
  const Octree& own = beside.apart.own.octree;
  std::int64_t leaves = 0, sum = 0;
  own.for_each_cube([&](IVec3 at, int edge, std::uint8_t tissue) {
    if (!own.is_solid(tissue)) return;
    const std::int64_t n = std::int64_t{edge} * edge * edge;
    leaves += n;
    sum += n * (2 * std::int64_t{at.x} + edge);
  });
  bool there = false;
  beside.apart.neighbours.for_each_cube([&](IVec3 at, int edge, std::uint8_t) {
    there = there || side * ((2 * std::int64_t{at.x} + edge) * leaves - sum) > 0;
  });
  return there;
}

void measure_clearance(const GradeInput& input, AdjacentMeasures& m) {
  m.clearance_bound_mm = input.zones.leaf_mm();
  const Octree& neighbours = input.beside->apart.neighbours;
  const Vec3 sight{k_sight_mm, k_sight_mm, k_sight_mm};
  const Vec3 low = input.zones.target_low_mm() - sight, high = input.zones.target_high_mm() + sight;
  const SiteBlocks surface = surface_of(neighbours, low, high);
  if (surface.empty()) return;
  ToSurface to(neighbours, surface);
  Octree::Cursor cursor;
  for (const int side : {1, -1}) {
    if (!stands_on(*input.beside, side)) continue;
    ContactRows(input, side).for_each_left([&](IVec3 leaf) {
      const Vec3 from = surface_by(input.after, leaf, cursor).at_mm;
      Vec3 place;
      const double d = to.mm(from, place);
      if (m.clearance_mm && d >= *m.clearance_mm) return;
      m.clearance_mm = d;
      m.clearance_from_mm = from;
      m.clearance_to_mm = place;
    });
  }
}

void measure_gum_time(std::span<const RemovedAt> gum, AdjacentMeasures& m) {
  std::set<std::int64_t> windows;
  for (const auto& r : gum) windows.insert(r.tick / k_gum_window_ticks);
  constexpr double k_window_s = k_gum_window_ticks * k_tick_s;
  std::int64_t last = -2;
  for (const std::int64_t w : windows) {
    m.gum_touched_s += k_window_s;
    if (w != last + 1) m.gum_touched_bound_s += k_window_s;
    last = w;
  }
}

}  // namespace

AdjacentMeasures measure_adjacent(const GradeInput& input, std::int64_t last_tick,
                                  VolumeMeasures& volumes) {
  AdjacentMeasures m;
  const ToothApart& apart = input.beside->apart;
  const Octree& before = input.beside->before.octree;
  const double leaf_mm3 = before.leaf_volume_mm3();
  const auto counts = before.count_leaves();
  for (std::size_t t = 0; t < counts.size(); ++t) {
    m.neighbours = m.neighbours || (apart.of_neighbours[t] && counts[t] > 0);
    m.gum = m.gum || (apart.of_gum[t] && counts[t] > 0);
  }
  const RemovedMap removed(input.beside->removed, last_tick);
  std::vector<RemovedAt> nick, gum;
  for_each_removed(input.beside->removed, removed, last_tick, [&](const RemovedAt& r) {
    if (!apart.beside[r.leaf.tissue]) return;
    const IVec3 leaf = r.leaf.leaf();
    const bool at_border =
        std::any_of(std::begin(scenarios::k_six_neighbours), std::end(scenarios::k_six_neighbours),
                    [&](IVec3 step) { return !removed.has(leaf + step); });
    const double unsure_mm3 = at_border ? 0.5 * leaf_mm3 : 0.0;
    const auto add = [&](BoundedVolume& v) {
      v.mm3 += leaf_mm3;
      v.bound_mm3 += unsure_mm3;
    };
    const Trace here{r.tick, before.centre_mm(leaf)};
    const auto begin = [&](Trace& first) {
      if (first.tick < 0) first = here;
    };
    add(volumes.tissue[r.leaf.tissue]);
    begin(volumes.tissue_first[r.leaf.tissue]);
    if (input.zones.zone(leaf) == scenarios::Zone::protected_) {
      scenarios::Zone z = scenarios::Zone::protected_;
      add(volumes.zone[static_cast<std::size_t>(z)].removed);
      begin(volumes.zone[static_cast<std::size_t>(z)].first);
    }
    add(apart.of_gum[r.leaf.tissue] ? m.gum_removed : m.neighbour_removed);
    begin(apart.of_gum[r.leaf.tissue] ? m.first_gum : m.first_nick);
    (apart.of_gum[r.leaf.tissue] ? gum : nick).push_back(r);
  });
  if (m.neighbours) {
    measure_nick(input, nick, m);
    measure_clearance(input, m);
  }
  measure_gum_time(gum, m);
  return m;
}

}  // namespace cavum::grading
