#include "grading/measures/volumes.h"

#include <algorithm>
#include <cmath>

#include "grading/measures/bounds.h"
#include "scenarios/zones/leaf_parts.h"

namespace cavum::grading {
namespace {

/// A step of the octree's distance code, leaves. Less than that of a leaf is not left: a cut
/// exactly along the target's surface removes all of the target.
constexpr double k_code = k_distance_band_leaves / k_distance_far;

/// How much of a leaf, 0..1: all of it or nothing, or part by part.
struct Share {
  bool all_or_nothing = true;
  bool all = false;
  scenarios::LeafParts parts;  // otherwise
  explicit Share(bool is_all) : all(is_all) {}
  explicit Share(const scenarios::LeafParts& p) : all_or_nothing(false), parts(p) {}
};

/// Of a leaf at a border, what is not known of it: a half where leaves count whole. Where they
/// count by parts, by the octree's own distance, volumes of known cavities at 80 poses are true to
/// 0.008 of a leaf at each (tests/grading/marking/known_geometry_test.cpp), and four times that is
/// promised; but where the cut and a zone's border pass through one leaf, a thin zone may be off by
/// a fifth of it, and a quarter is promised.
constexpr double k_whole = 0.5, k_by_parts = 0.03, k_two_borders = 0.25;

/// The leaf lies where what is beyond the target's bottom meets what is beyond its sides: leaves go
/// whole to one or the other.
bool divided(const scenarios::ZoneMap& zones, IVec3 leaf) {
  const bool bottom = zones.wall(leaf) == scenarios::Wall::floor;
  return std::any_of(
      std::begin(scenarios::k_six_neighbours), std::end(scenarios::k_six_neighbours),
      [&](IVec3 step) { return (zones.wall(leaf + step) == scenarios::Wall::floor) != bottom; });
}

/// Of what a zone has in a leaf: `share` of it, of `total` that is gone.
double unsure_of(bool whole, double share, double total) {
  if (whole) return k_whole;
  return total < 1.0 - k_code && share < total - k_code ? k_two_borders : k_by_parts;
}

/// Shares of one leaf's parts, each 0..1: removed, and in target and leeway and container together
/// up to each level.
class Shares {
 public:
  Shares(const GradeInput& input, const RemovedMap& removed, bool late)
      : input_(input), removed_(removed), leaf_mm_(input.zones.leaf_mm()), late_(late) {}
  /// Leaves went after the end: everything counts whole.
  [[nodiscard]] bool late() const { return late_; }
  /// Of what a zone has in a leaf, what is not known: `share` of it, of `total` that is gone.
  [[nodiscard]] double unsure(double share, double total) const {
    return unsure_of(late_, share, total) + input_.surface_mean_bound_mm / leaf_mm_;
  }

  [[nodiscard]] Share removed(IVec3 leaf, std::uint8_t tissue) const {
    const bool gone = removed_.has(leaf);
    if (late_ || !input_.before.octree.is_solid(tissue)) return Share(gone);
    const double centre = decode_distance(input_.after.distance_code(leaf, after_));
    if (gone ? centre > scenarios::k_parts_reach_leaves : centre < -scenarios::k_parts_reach_leaves)
      return Share(gone);
    scenarios::LeafParts parts = scenarios::leaf_parts(
        leaf, [&](IVec3 l) { return decode_distance(input_.after.distance_code(l, after_)); });
    for (double& p : parts) p = scenarios::share_beyond(p);
    if (gone) return Share(parts);
    const scenarios::LeafParts before = scenarios::leaf_parts(leaf, [&](IVec3 l) {
      return decode_distance(input_.before.octree.distance_code(l, before_));
    });
    for (std::size_t i = 0; i < scenarios::k_parts; ++i)
      parts[i] = std::min(parts[i], scenarios::share_beyond(-before[i]));
    return Share(parts);
  }
  /// Part of the leaf that lies nearer to the target than `level_mm`, or inside it.
  [[nodiscard]] Share within(IVec3 leaf, double level_mm) const {
    const double centre = (level_mm - input_.zones.distance_mm(leaf)) / leaf_mm_;
    if (std::fabs(centre) > scenarios::k_parts_reach_leaves) return Share(centre > 0);
    scenarios::LeafParts parts = scenarios::leaf_parts(
        leaf, [&](IVec3 l) { return (level_mm - input_.zones.distance_mm(l)) / leaf_mm_; });
    for (double& p : parts) p = scenarios::share_beyond(p);
    return Share(parts);
  }

 private:
  const GradeInput& input_;
  const RemovedMap& removed_;
  double leaf_mm_;
  bool late_;
  mutable Octree::Cursor before_, after_;
};

double sum(const Share& share) {
  if (share.all_or_nothing) return share.all ? 1.0 : 0.0;
  double s = 0;
  for (const double p : share.parts) s += p;
  return s / scenarios::k_parts;
}
double sum_of_both(const Share& a, const Share& b) {
  if (a.all_or_nothing) return a.all ? sum(b) : 0.0;
  if (b.all_or_nothing) return b.all ? sum(a) : 0.0;
  double s = 0;
  for (std::size_t i = 0; i < scenarios::k_parts; ++i) s += std::min(a.parts[i], b.parts[i]);
  return s / scenarios::k_parts;
}

/// Leaves, as a sum of shares, and how many of them are not known.
struct Count {
  double leaves = 0, unsure = 0;
};

/// Gives each zone what of a leaf was removed in it, what of that is not known where it lies at a
/// border, and what may as well belong to the sides in place of the bottom or the other way round,
/// in leaves; returns the sum.
template <class Give>
double share_out(const GradeInput& input, const Shares& shares, IVec3 leaf, std::uint8_t held,
                 const Give& give) {
  const scenarios::ZoneMap& zones = input.zones;
  const Share gone = shares.removed(leaf, held);
  const double total = sum(gone);
  if (!(total > 0)) return 0;
  const scenarios::Zone own = zones.zone(leaf);
  const auto part = [&](scenarios::Zone z, double share, bool may_be_others = false) {
    if (share > 0) give(z, share, shares.unsure(share, total), may_be_others ? share : 0.0);
  };
  if (shares.late() || !zones.in_box(leaf)) {
    part(own, total);
    return total;
  }
  const double target = sum_of_both(gone, shares.within(leaf, 0));
  part(scenarios::Zone::target, target);
  if (own == scenarios::Zone::protected_) {
    part(scenarios::Zone::protected_, total - target);
    return total;
  }
  const scenarios::ZoneSpec& spec = input.scenario.zones;
  const bool bottom = zones.wall(leaf) == scenarios::Wall::floor;
  const double leeway_mm = bottom ? spec.leeway.bottom_mm : spec.leeway.sides_mm;
  const double container_mm =
      std::max(leeway_mm, bottom ? spec.container.bottom_mm : spec.container.sides_mm);
  const double leeway = leeway_mm > 0 ? sum_of_both(gone, shares.within(leaf, leeway_mm)) : target;
  const double container =
      container_mm > 0 ? sum_of_both(gone, shares.within(leaf, container_mm)) : leeway;
  const bool other = container > target && divided(zones, leaf);
  part(bottom ? scenarios::Zone::leeway_bottom : scenarios::Zone::leeway_sides, leeway - target,
       other);
  part(bottom ? scenarios::Zone::container_bottom : scenarios::Zone::container_sides,
       container - leeway, other);
  part(scenarios::Zone::none, total - container);
  return total;
}

/// Calls `visit(leaf, tissue, tick)` for each removed leaf, then, with tick -1, for each solid one
/// that stayed beside them and may be gone in part.
template <class Visit>
void for_each_touched(const GradeInput& input, const RemovedMap& removed, std::int64_t last_tick,
                      bool late, RemovedMap::Marks& seen, const Visit& visit) {
  std::vector<IVec3> beside;
  for_each_removed(input.removed, removed, last_tick, [&](const RemovedAt& r) {
    const IVec3 leaf = r.leaf.leaf();
    visit(leaf, r.leaf.tissue, r.tick);
    if (late) return;
    for (int i = 0; i < 27; ++i) {
      const IVec3 n = leaf + IVec3{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
      if (!removed.has(n) && seen.first_time(n)) beside.push_back(n);
    }
  });
  const Octree& before = input.before.octree;
  Octree::Cursor cursor;
  for (const IVec3 leaf : beside)
    if (const std::uint8_t held = before.tissue(leaf, cursor); before.is_solid(held))
      visit(leaf, held, std::int64_t{-1});
}

bool removed_late(const GradeInput& input, std::int64_t last_tick) {
  return std::any_of(input.removed.begin(), input.removed.end(),
                     [&](const RemovedAt& r) { return r.tick > last_tick; });
}

/// Something that stayed lies beside the leaf, or it did itself.
bool beside_what_stayed(const RemovedMap& removed, IVec3 leaf, std::int64_t tick) {
  return tick < 0 ||
         std::any_of(std::begin(scenarios::k_six_neighbours), std::end(scenarios::k_six_neighbours),
                     [&](IVec3 step) { return !removed.has(leaf + step); });
}

/// When a leaf went; of one that is gone in part, when the last leaf beside it did.
std::int64_t tick_of(const RemovedMap& removed, IVec3 leaf, std::int64_t tick) {
  for (int i = 0; i < 27 && tick < 0; ++i)
    tick = std::max(tick, removed.tick(leaf + IVec3{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}));
  return tick;
}

}  // namespace

bool on_border(const scenarios::ZoneMap& zones, const RemovedMap& removed, IVec3 leaf) {
  return std::any_of(std::begin(scenarios::k_six_neighbours), std::end(scenarios::k_six_neighbours),
                     [&](IVec3 step) {
                       return !removed.has(leaf + step) ||
                              zones.zone(leaf + step) != zones.zone(leaf);
                     });
}

namespace {

/// What was removed, in leaves.
struct RemovedCount {
  std::array<Count, scenarios::k_zones> zone{};
  std::array<Count, 256> tissue{};
  Count all;
};

/// Counts it by zone, wall and tissue; `v` gets the walls' parts and when each began. `seen` are
/// the leaves that may be gone in part.
RemovedCount count_removed(const GradeInput& input, const RemovedMap& removed,
                           std::int64_t last_tick, const Shares& shares, RemovedMap::Marks& seen,
                           VolumeMeasures& v) {
  const scenarios::ZoneMap& zones = input.zones;
  RemovedCount count;
  for_each_touched(input, removed, last_tick, shares.late(), seen,
                   [&](IVec3 leaf, std::uint8_t held, std::int64_t tick) {
                     const bool edge = beside_what_stayed(removed, leaf, tick);
                     if (tick >= 0) {
                       count.tissue[held].leaves += 1;
                       count.tissue[held].unsure += on_border(zones, removed, leaf) ? k_whole : 0.0;
                       Trace& first = v.tissue_first[held];
                       if (first.tick < 0 || tick < first.tick)
                         first = {tick, zones.centre_mm(leaf)};
                     }
                     const std::int64_t when = tick_of(removed, leaf, tick);
                     const auto wall = static_cast<std::size_t>(zones.wall(leaf));
                     if (Trace& last = v.target_last[wall];
                         tick > last.tick && zones.zone(leaf) == scenarios::Zone::target)
                       last = {tick, zones.centre_mm(leaf)};
                     const double total = share_out(
                         input, shares, leaf, held,
                         [&](scenarios::Zone z, double share, double unsure, double others) {
                           const auto i = static_cast<std::size_t>(z);
                           count.zone[i].leaves += share;
                           count.zone[i].unsure += edge || share < 1 ? unsure : 0.0;
                           v.zone[i].bottom_or_sides_mm3 += others * zones.leaf_volume_mm3();
                           v.zone[i].by_wall_mm3[wall] += share * zones.leaf_volume_mm3();
                           Trace& first = v.zone[i].first;
                           if (first.tick < 0 || when < first.tick)
                             first = {when, zones.centre_mm(leaf)};
                         });
                     count.all.leaves += total;
                     if (total > 0)
                       count.all.unsure += edge || total < 1 ? shares.unsure(total, total) : 0.0;
                   });
  return count;
}

/// The target in leaves, and what of it was left standing.
struct TargetCount {
  double leaves = 0;
  Count missed;
};

/// Calls `visit(leaf, share, left)` for each leaf with a part in the target: that part, and what of
/// it was left standing. `seen` are the leaves that may be gone in part.
template <class Visit>
void for_each_in_target(const GradeInput& input, const RemovedMap& removed, const Shares& shares,
                        const RemovedMap::Marks& seen, const Visit& visit) {
  const scenarios::ZoneMap& zones = input.zones;
  const Octree& before = input.before.octree;
  const double reach_mm = scenarios::k_parts_reach_leaves * zones.leaf_mm();
  Octree::Cursor cursor;
  zones.for_each_leaf([&](IVec3 leaf, scenarios::Zone z) {
    const double d = zones.distance_mm(leaf);
    if (z != scenarios::Zone::target && (shares.late() || d > reach_mm)) return;
    if (z != scenarios::Zone::target && before.tissue(leaf, cursor) == k_air) return;
    const Share in = shares.late() || d < -reach_mm ? Share(true) : shares.within(leaf, 0);
    const double share = sum(in);
    if (share < k_code) return;
    const bool untouched = !removed.has(leaf) && !seen.seen(leaf);
    LeftShare left;
    left.leaves = untouched
                      ? share
                      : share - sum_of_both(in, shares.removed(leaf, before.tissue(leaf, cursor)));
    if (left.leaves < k_code) return visit(leaf, share, LeftShare{});
    bool edge = left.leaves < 1;
    for (const IVec3 step : scenarios::k_six_neighbours)
      edge = edge || removed.has(leaf + step) || zones.zone(leaf + step) != scenarios::Zone::target;
    left.unsure = edge ? shares.unsure(left.leaves, share) : 0.0;
    visit(leaf, share, left);
  });
}

/// Counts both; `v` gets the walls' parts.
TargetCount count_target(const GradeInput& input, const RemovedMap& removed, const Shares& shares,
                         const RemovedMap::Marks& seen, VolumeMeasures& v) {
  const double leaf_mm3 = input.zones.leaf_volume_mm3();
  TargetCount count;
  for_each_in_target(input, removed, shares, seen,
                     [&](IVec3 leaf, double share, const LeftShare& left) {
                       const auto wall = static_cast<std::size_t>(input.zones.wall(leaf));
                       count.leaves += share;
                       v.target_by_wall_mm3[wall] += share * leaf_mm3;
                       count.missed.leaves += left.leaves;
                       count.missed.unsure += left.unsure;
                       v.missed_by_wall_mm3[wall] += left.leaves * leaf_mm3;
                       v.missed_bound_by_wall_mm3[wall] += left.unsure * leaf_mm3;
                     });
  return count;
}

BoundedVolume volume_of(const Count& c, double leaf_mm3) {
  return {c.leaves * leaf_mm3, c.unsure * leaf_mm3};
}

void put_volumes(VolumeMeasures& v, const RemovedCount& removed, const TargetCount& target,
                 const scenarios::ZoneMap& zones, bool whole) {
  const double leaf_mm3 = zones.leaf_volume_mm3();
  for (std::size_t z = 0; z < scenarios::k_zones; ++z)
    v.zone[z].removed = volume_of(removed.zone[z], leaf_mm3);
  for (std::size_t t = 0; t < 256; ++t) v.tissue[t] = volume_of(removed.tissue[t], leaf_mm3);
  v.target = volume_of({target.leaves, (whole ? k_whole : k_by_parts) *
                                           static_cast<double>(zones.target_border_leaves())},
                       leaf_mm3);
  v.removed = volume_of(removed.all, leaf_mm3);
  v.missed = volume_of(target.missed, leaf_mm3);
}

/// The share of the target that was removed, and Dice.
void put_shares(VolumeMeasures& v, const RemovedCount& removed, const TargetCount& target) {
  const BoundedVolume& in_target =
      v.zone[static_cast<std::size_t>(scenarios::Zone::target)].removed;
  BoundedVolume beyond;
  for (std::size_t z = 0; z < scenarios::k_zones; ++z)
    if (z != static_cast<std::size_t>(scenarios::Zone::target)) {
      beyond.mm3 += v.zone[z].removed.mm3;
      beyond.bound_mm3 += v.zone[z].removed.bound_mm3;
    }
  v.target_removed_percent = 100.0 * (target.leaves - target.missed.leaves) / target.leaves;
  v.target_removed_bound_percent = share_bound_percent(in_target, v.missed);
  v.dice = 2.0 * (target.leaves - target.missed.leaves) / (removed.all.leaves + target.leaves);
  v.dice_bound = dice_bound(in_target, v.missed, beyond);
}

}  // namespace

void for_each_removed_share(const GradeInput& input, const RemovedMap& removed,
                            std::int64_t last_tick,
                            const std::function<void(const RemovedShare&)>& visit) {
  const Shares shares(input, removed, removed_late(input, last_tick));
  RemovedMap::Marks seen = removed.marks();
  for_each_touched(input, removed, last_tick, shares.late(), seen,
                   [&](IVec3 leaf, std::uint8_t held, std::int64_t tick) {
                     const bool edge = beside_what_stayed(removed, leaf, tick);
                     const std::int64_t when = tick_of(removed, leaf, tick);
                     share_out(
                         input, shares, leaf, held,
                         [&](scenarios::Zone z, double share, double unsure, double others) {
                           const double leaf_mm3 = input.zones.leaf_volume_mm3();
                           visit({leaf, held, when, z, share * leaf_mm3,
                                  edge || share < 1 ? unsure * leaf_mm3 : 0.0, others * leaf_mm3});
                         });
                   });
}

void for_each_left_in_target(const GradeInput& input, const RemovedMap& removed,
                             std::int64_t last_tick,
                             const std::function<void(IVec3, const LeftShare&)>& visit) {
  const Shares shares(input, removed, removed_late(input, last_tick));
  RemovedMap::Marks seen = removed.marks();
  for_each_touched(input, removed, last_tick, shares.late(), seen,
                   [](IVec3, std::uint8_t, std::int64_t) {});
  for_each_in_target(input, removed, shares, seen, [&](IVec3 leaf, double, const LeftShare& left) {
    if (left.leaves > 0) visit(leaf, left);
  });
}

VolumeMeasures measure_volumes(const GradeInput& input, const RemovedMap& removed,
                               std::int64_t last_tick) {
  const Shares shares(input, removed, removed_late(input, last_tick));
  VolumeMeasures v;
  RemovedMap::Marks seen = removed.marks();
  const RemovedCount gone = count_removed(input, removed, last_tick, shares, seen, v);
  const TargetCount target = count_target(input, removed, shares, seen, v);
  put_volumes(v, gone, target, input.zones, shares.late());
  put_shares(v, gone, target);
  return v;
}

}  // namespace cavum::grading
