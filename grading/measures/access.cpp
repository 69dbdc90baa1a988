#include "grading/measures/access.h"

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"
#include "engine/tooth/octree_edit.h"
#include "grading/measures/bounds.h"
#include "grading/measures/cut_surface.h"
#include "grading/measures/volumes.h"
#include "scenarios/zones/leaf_parts.h"

namespace cavum::grading {
namespace {

/// A mark for each leaf of the zones' box; 0 = none.
template <class Mark>
class Marks {
 public:
  explicit Marks(const scenarios::ZoneMap& zones)
      : low_(zones.low()), size_(zones.size()), mark_(cells_of(size_), Mark{}) {}
  [[nodiscard]] Mark at(IVec3 leaf) const noexcept {
    const IVec3 l = leaf - low_;
    return lies_in(l, size_) ? mark_[index(l)] : Mark{};
  }
  void set(IVec3 leaf, Mark mark) noexcept { mark_[index(leaf - low_)] = mark; }
  /// What of a cube of leaves lies in the box.
  void set_cube(IVec3 at, int edge, Mark mark) noexcept {
    const IVec3 a = at - low_;
    for (int z = std::max(0, a.z); z < std::min(size_.z, a.z + edge); ++z)
      for (int y = std::max(0, a.y); y < std::min(size_.y, a.y + edge); ++y)
        for (int x = std::max(0, a.x); x < std::min(size_.x, a.x + edge); ++x)
          mark_[index({x, y, z})] = mark;
  }

 private:
  [[nodiscard]] std::size_t index(IVec3 l) const noexcept { return cell_index(l, size_); }
  IVec3 low_, size_;
  std::vector<Mark> mark_;
};

/// Connected pieces of marked leaves (over corners, too), in their order; the marks are used up.
/// `add(piece, mark)` counts a leaf to a piece.
template <class Mark, class Add>
std::vector<Piece> pieces_of(Marks<Mark>& marks, const std::vector<IVec3>& leaves,
                             const scenarios::ZoneMap& zones, const Add& add) {
  std::vector<Piece> pieces;
  std::vector<IVec3> next;
  for (const IVec3 first : leaves) {
    if (marks.at(first) == Mark{}) continue;
    Piece piece;
    Vec3 sum;
    double n = 0;
    const auto take = [&](IVec3 leaf) {
      const Mark mark = marks.at(leaf);
      if (mark == Mark{}) return;
      add(piece, mark);
      sum += zones.centre_mm(leaf);
      n += 1;
      marks.set(leaf, Mark{});
      next.push_back(leaf);
    };
    take(first);
    while (!next.empty()) {
      const IVec3 leaf = next.back();
      next.pop_back();
      for (int i = 0; i < 27; ++i) take(leaf + IVec3{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1});
    }
    piece.middle_mm = sum / n;
    pieces.push_back(piece);
  }
  return pieces;
}

using AimLeaves = Marks<std::uint8_t>;

AimLeaves aim_leaves(const GradeInput& input) {
  AimLeaves aim(input.zones);
  std::array<bool, 256> wanted{};
  for (const auto& t : input.before.tissues)
    for (const auto& name : input.scenario.perforation.aims)
      wanted[t.id] = wanted[t.id] || t.name == name;
  input.before.octree.for_each_cube([&](IVec3 at, int edge, std::uint8_t tissue) {
    if (wanted[tissue]) aim.set_cube(at, edge, 1);
  });
  return aim;
}

void measure_overhang(const GradeInput& input, const RemovedMap& removed, std::int64_t last_tick,
                      const AimLeaves& aim, AccessMeasures& m) {
  const scenarios::ZoneMap& zones = input.zones;
  const Octree& tree = input.before.octree;
  const Vec3 down = zones.approach() * (-0.5 * zones.leaf_mm());
  bool any_aim = false;
  zones.for_each_target_leaf([&](IVec3 leaf) { any_aim = any_aim || aim.at(leaf) != 0; });
  if (!any_aim) return;  // this target opens nothing
  const double leaf_mm3 = zones.leaf_volume_mm3(),
               reach_mm = scenarios::k_parts_reach_leaves * zones.leaf_mm();
  const auto in_target = [&](IVec3 leaf) {
    return zones.in_box(leaf) && zones.distance_mm(leaf) < reach_mm;
  };
  Marks<float> left_mm3(zones);
  std::vector<IVec3> leaves;
  Vec3 sum;
  BoundedVolume overhang;
  for_each_left_in_target(input, removed, last_tick, [&](IVec3 leaf, const LeftShare& left) {
    if (!tree.is_solid(tree.tissue(leaf))) return;
    Vec3 p = zones.centre_mm(leaf);
    for (IVec3 below = leaf; in_target(below); p += down, below = tree.leaf_at(p))
      if (aim.at(below) != 0) {
        const auto mm3 = static_cast<float>(left.leaves * leaf_mm3);
        left_mm3.set(leaf, mm3);
        leaves.push_back(leaf);
        overhang.mm3 += static_cast<double>(mm3);
        overhang.bound_mm3 += left.unsure * leaf_mm3;
        sum += zones.centre_mm(leaf) * static_cast<double>(mm3);
        return;
      }
  });
  m.overhang = overhang;
  if (!leaves.empty()) m.overhang_middle_mm = sum / overhang.mm3;
  m.overhang_pieces = pieces_of(left_mm3, leaves, zones, [](Piece& piece, float mm3) {
    piece.part += static_cast<double>(mm3);
    piece.whole += static_cast<double>(mm3);
  });
  std::stable_sort(m.overhang_pieces.begin(), m.overhang_pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.part > b.part; });
}

/// How far a share may be off, percent: `covered` and `open` mouths, of which so many lie on a
/// mouth's rim, where half a leaf more or less belongs to it, and `edge` ones where half a leaf
/// more or less may be covered. Rims alone tell nothing when all mouths are covered, or all open.
double covered_bound_percent(double covered, double open, double covered_rim, double open_rim,
                             double edge) {
  const auto share = [](double a, double b) { return a > 0 ? a / (a + std::max(0.0, b)) : 0.0; };
  const double now = share(covered, open),
               high = share(covered + 0.5 * (covered_rim + edge), open - 0.5 * (open_rim + edge)),
               low = share(covered - 0.5 * (covered_rim + edge), open + 0.5 * (open_rim + edge));
  return 100.0 * std::max(high - now, now - low);
}

void measure_canals(const GradeInput& input, const AimLeaves& aim, AccessMeasures& m) {
  constexpr std::uint8_t k_open = 1, k_covered = 2;
  const scenarios::ZoneMap& zones = input.zones;
  const Octree& tree = input.before.octree;
  const Vec3 up = zones.approach() * (0.5 * zones.leaf_mm());
  const auto covered_from = [&](IVec3 leaf) {  // its straight line out meets hard tissue
    Vec3 p = zones.centre_mm(leaf);
    for (; zones.in_box(leaf); p += up, leaf = tree.leaf_at(p))
      if (input.after.is_solid(input.after.tissue(leaf))) return true;
    return false;
  };
  Marks<std::uint8_t> mouth(zones);
  std::vector<IVec3> mouths;
  double covered = 0;
  Vec3 sum;
  zones.for_each_leaf([&](IVec3 leaf, scenarios::Zone zone) {
    if (zone == scenarios::Zone::target || aim.at(leaf) == 0 ||
        zones.wall(leaf) != scenarios::Wall::floor)
      return;
    if (zones.zone(tree.leaf_at(zones.centre_mm(leaf) + up * 2.0)) != scenarios::Zone::target)
      return;
    const bool blocked = covered_from(leaf);
    mouth.set(leaf, blocked ? k_covered : k_open);
    mouths.push_back(leaf);
    covered += blocked ? 1 : 0;
    if (blocked) sum += zones.centre_mm(leaf);
  });
  if (mouths.empty()) return;
  double covered_rim = 0, open_rim = 0, edge = 0;
  for (const IVec3 leaf : mouths) {
    const bool blocked = mouth.at(leaf) == k_covered;
    bool at_rim = false, at_edge = false;
    // what covers a mouth's corner alone lies over the leaf beyond that corner
    for (const IVec3 step : {IVec3{1, 0, 0}, IVec3{-1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, -1, 0},
                             IVec3{1, 1, 0}, IVec3{1, -1, 0}, IVec3{-1, 1, 0}, IVec3{-1, -1, 0}}) {
      const std::uint8_t beside = mouth.at(leaf + step);
      at_rim = at_rim || (beside == 0 && step.x * step.y == 0);
      // beside a mouth the floor is hard: what covers lies above it
      const bool blocked_adjacent =
          beside == 0 ? covered_from(tree.leaf_at(zones.centre_mm(leaf + step) + up * 2.0))
                      : beside == k_covered;
      at_edge = at_edge || blocked_adjacent != blocked;
    }
    (blocked ? covered_rim : open_rim) += at_rim ? 1 : 0;
    edge += at_edge ? 1 : 0;
  }
  const auto all = static_cast<double>(mouths.size());
  m.canals_covered_percent = 100.0 * covered / all;
  m.canals_bound_percent =
      covered_bound_percent(covered, all - covered, covered_rim, open_rim, edge);
  if (covered > 0) m.canals_covered_mm = sum / covered;
  m.canal_mouths = pieces_of(mouth, mouths, zones, [](Piece& piece, std::uint8_t mark) {
    piece.part += mark == k_covered ? 1 : 0;
    piece.whole += 1;
  });
}

void measure_floor(const GradeInput& input, const RemovedMap& removed, std::int64_t last_tick,
                   AccessMeasures& m) {
  const scenarios::ZoneMap& zones = input.zones;
  const auto below = [&](IVec3 leaf) {
    return zones.zone(leaf) != scenarios::Zone::target &&
           zones.wall(leaf) == scenarios::Wall::floor;
  };
  std::uint64_t count = 0, border = 0;
  for_each_removed(input.removed, removed, last_tick, [&](const RemovedAt& r) {
    const IVec3 leaf = r.leaf.leaf();
    if (!input.before.octree.is_solid(r.leaf.tissue) || !below(leaf)) return;
    if (count++ == 0) m.floor_first = {r.tick, zones.centre_mm(leaf)};
    for (const IVec3 step : scenarios::k_six_neighbours)
      if (!removed.has(leaf + step) || !below(leaf + step)) {
        ++border;
        break;
      }
  });
  m.floor_cut = {static_cast<double>(count) * zones.leaf_volume_mm3(),
                 0.5 * static_cast<double>(border) * zones.leaf_volume_mm3()};
}

void measure_target_taper(const GradeInput& input, AccessMeasures& m) {
  constexpr double k_cos_45 = 0.70710678118654752440;
  const scenarios::ZoneMap& zones = input.zones;
  const Octree& before = input.before.octree;
  const double leaf = zones.leaf_mm();
  const scenarios::Facing facing = zones.facing();
  double up = 0, across = 0;
  std::vector<WallHeight> walls(scenarios::k_walls + 1);
  zones.for_each_target_leaf([&](IVec3 at) {
    bool at_wall = false;
    for (const IVec3 step : scenarios::k_six_neighbours)
      at_wall = at_wall || (zones.zone(at + step) != scenarios::Zone::target &&
                            before.is_solid(before.tissue(at + step)));
    if (!at_wall) return;
    const Vec3 p = zones.centre_mm(at);
    const auto slope = [&](Vec3 step) {
      return zones.distance_mm(p + step * leaf) - zones.distance_mm(p - step * leaf);
    };
    const Vec3 inwards =
        facing.local(normalized(-Vec3{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})}));
    const double height = facing.local(p).z;
    if (std::fabs(inwards.z) >= k_cos_45) return;
    WallHeight& wall = walls[static_cast<std::size_t>(zones.wall(at))];
    wall.places += 1;
    wall.low_mm = std::min(wall.low_mm, height);
    wall.high_mm = std::max(wall.high_mm, height);
    up += inwards.z;
    across += std::sqrt(inwards.x * inwards.x + inwards.y * inwards.y);
  });
  if (across > 0) m.target_taper_deg = atan_deg(up / across);
  m.target_taper_bound_deg = taper_bound_deg(walls, leaf);
}

}  // namespace

AccessMeasures measure_access(const GradeInput& input, const RemovedMap& removed,
                              std::int64_t last_tick) {
  AccessMeasures m;
  if (!input.scenario.perforation.aims.empty()) {
    const AimLeaves aim = aim_leaves(input);
    measure_overhang(input, removed, last_tick, aim, m);
    measure_canals(input, aim, m);
  }
  measure_floor(input, removed, last_tick, m);
  measure_target_taper(input, m);
  return m;
}

}  // namespace cavum::grading
