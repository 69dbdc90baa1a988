#include "scenarios/zones/zone_map.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/tooth/distance_transform.h"
#include "scenarios/zones/leaf_parts.h"
#include "scenarios/zones/shape.h"

namespace cavum {
namespace {

constexpr double k_cos_45 = 0.70710678118654752440;

struct TargetBox {
  IVec3 low, high;  // inclusive, exclusive
};

/// Leaves around the part of the target that lies in the tooth.
TargetBox find_target(const Shape& target, const Tooth& tooth, const std::string& where, ZoneWork& work) {
  const Octree& tree = tooth.octree;
  const IVec3 n = tree.size();
  TargetBox box{{n.x, n.y, n.z}, {-1, -1, -1}};
  const auto see = [&](IVec3 leaf) {
    const bool seen =
        leaf.x >= box.low.x && leaf.y >= box.low.y && leaf.z >= box.low.z && leaf.x < box.high.x && leaf.y < box.high.y && leaf.z < box.high.z;
    if (seen || target.distance_mm(tree.centre_mm(leaf)) >= 0) return;
    box.low = {std::min(box.low.x, leaf.x), std::min(box.low.y, leaf.y), std::min(box.low.z, leaf.z)};
    box.high = {std::max(box.high.x, leaf.x + 1), std::max(box.high.y, leaf.y + 1), std::max(box.high.z, leaf.z + 1)};
  };
  // every second leaf of large cubes, every small one: a target thinner than two leaves is none
  const auto step_in = [](int edge) { return edge >= 4 ? 2 : 1; };
  std::uint64_t leaves = 0;
  tree.for_each_cube([&](IVec3, int edge, std::uint8_t) {
    const auto along = static_cast<std::uint64_t>(edge / step_in(edge));
    leaves += along * along * along;
  });
  work.steps(leaves, target.pieces());
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t) {
    const int step = step_in(edge);
    for (int z = 0; z < edge; z += step)
      for (int y = 0; y < edge; y += step)
        for (int x = 0; x < edge; x += step) see(at + IVec3{x, y, z});
  });
  if (box.high.x < 0)
    throw Error(where, "no part of the target lies in the tooth '" + tooth.name + "'", "move or enlarge [[zones.target]], or choose another tooth");
  return box;
}

std::uint64_t leaves_with_tissue(const Octree& tree) {
  std::uint64_t leaves = 0;
  tree.for_each_cube([&](IVec3, int edge, std::uint8_t tissue) {
    if (tissue != k_air) leaves += static_cast<std::uint64_t>(edge) * static_cast<std::uint64_t>(edge) * static_cast<std::uint64_t>(edge);
  });
  return leaves;
}

}  // namespace

const char* zone_name(Zone zone) noexcept {
  constexpr const char* k_names[k_zones] = {"outside", "target", "leeway sides", "leeway bottom", "container sides", "container bottom", "protected"};
  return k_names[static_cast<std::size_t>(zone)];
}

Wall wall_of(Vec3 d) noexcept {
  const double vertical = d.z, n = length(d);
  if (-vertical >= k_cos_45 * n) return Wall::floor;
  if (vertical >= k_cos_45 * n) return Wall::opening;
  if (std::fabs(d.x) >= std::fabs(d.y)) return d.x >= 0 ? Wall::mesial : Wall::distal;
  return d.y >= 0 ? Wall::buccal : Wall::lingual;
}

double ZoneMap::distance_mm(IVec3 leaf) const noexcept {
  return in_box(leaf) ? static_cast<double>(distance_mm_[index(leaf)]) : distance_mm(centre_mm(leaf));
}

double ZoneMap::distance_mm(Vec3 p) const noexcept {
  const Vec3 q = (p - origin_mm_) / leaf_mm_ - Vec3{low_.x + 0.5, low_.y + 0.5, low_.z + 0.5};
  const Vec3 c{std::clamp(q.x, 0.0, size_.x - 1.0), std::clamp(q.y, 0.0, size_.y - 1.0), std::clamp(q.z, 0.0, size_.z - 1.0)};
  const IVec3 i{std::min(static_cast<int>(c.x), std::max(0, size_.x - 2)), std::min(static_cast<int>(c.y), std::max(0, size_.y - 2)),
                std::min(static_cast<int>(c.z), std::max(0, size_.z - 2))};
  const double fx = c.x - i.x, fy = c.y - i.y, fz = c.z - i.z;
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    const IVec3 leaf =
        low_ + IVec3{std::min(i.x + (k & 1), size_.x - 1), std::min(i.y + (k >> 1 & 1), size_.y - 1), std::min(i.z + (k >> 2), size_.z - 1)};
    sum += static_cast<double>(distance_mm_[index(leaf)]) * ((k & 1) != 0 ? fx : 1 - fx) * ((k >> 1 & 1) != 0 ? fy : 1 - fy) *
           ((k >> 2) != 0 ? fz : 1 - fz);
  }
  return sum + length(q - c) * leaf_mm_;
}

Wall ZoneMap::wall(IVec3 leaf) const noexcept {
  const IVec3 in{std::clamp(leaf.x, low_.x, low_.x + size_.x - 1), std::clamp(leaf.y, low_.y, low_.y + size_.y - 1),
                 std::clamp(leaf.z, low_.z, low_.z + size_.z - 1)};
  return static_cast<Wall>(wall_[index(in)]);
}

void ZoneMap::guard_beyond(const Octree& tree, const Shape& guard) {
  tooth_size_ = tree.size();
  guarded_.assign(static_cast<std::size_t>(tooth_size_.x) * static_cast<std::size_t>(tooth_size_.y) * static_cast<std::size_t>(tooth_size_.z), false);
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t tissue) {
    if (tissue == k_air) return;
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
          const IVec3 leaf = at + IVec3{x, y, z};
          if (in_box(leaf) || !(guard.distance_mm(centre_mm(leaf)) < 0)) continue;
          guarded_[tooth_index(leaf)] = true;
          ++counts_[static_cast<std::size_t>(Zone::protected_)];
        }
  });
}

ZoneMap build_zones(const Scenario& scenario, const Tooth& tooth) {
  const Octree& tree = tooth.octree;
  const ZoneSpec& spec = scenario.zones;
  ShapeMaker maker(tooth, scenario.path);
  const auto target = maker.make(spec.target);
  const std::string where = spec.target.empty() ? scenario.path : place_text(scenario.path, spec.target[0]);
  const TargetBox box = find_target(*target, tooth, where, maker.work());
  const double leaf = tree.leaf_mm();

  ZoneMap map;
  map.leaf_mm_ = leaf;
  map.origin_mm_ = tree.origin_mm();
  constexpr double k_steep = 0.5;  // cosine: flatter ways in are no way for a handpiece
  if (const Vec3 axis = spec.target.empty() ? Vec3{0, 0, 1} : spec.target[0].axis; axis.z >= k_steep) map.approach_ = axis;
  const double margin_mm = std::max({spec.leeway.sides_mm, spec.leeway.bottom_mm, spec.container.sides_mm, spec.container.bottom_mm}) + 0.25;
  const int margin = static_cast<int>(margin_mm / leaf) + 2;
  const IVec3 n = tree.size(), high{std::min(n.x, box.high.x + margin), std::min(n.y, box.high.y + margin), std::min(n.z, box.high.z + margin)};
  map.low_ = {std::max(0, box.low.x - margin), std::max(0, box.low.y - margin), std::max(0, box.low.z - margin)};
  map.size_ = high - map.low_;
  const IVec3 size = map.size_;
  const auto cells = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);

  maker.work().zone_leaves(cells);

  const auto guard = spec.protected_shapes.empty() ? nullptr : maker.make(spec.protected_shapes);
  maker.work().steps(cells, target->pieces());
  if (guard != nullptr) maker.work().steps(cells + leaves_with_tissue(tree), guard->pieces());

  // 1. the shape at every leaf's centre, without what is protected
  std::vector<std::uint8_t> inside(cells), outside(cells);
  std::vector<float> level(cells);
  std::size_t i = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, ++i) {
        const Vec3 centre = map.centre_mm(map.low_ + IVec3{x, y, z});
        double d = target->distance_mm(centre);
        if (guard != nullptr) d = std::max(d, -guard->distance_mm(centre));
        level[i] = static_cast<float>(d);
        inside[i] = d < 0 ? 1 : 0;
        outside[i] = d < 0 ? 0 : 1;
      }

  // 2. true distances. Two points of the surface are tried and the nearer one counts: the place of the nearest
  // leaf across it, and the foot of the perpendicular on the surface's tangent there. Both are put on the
  // surface by the shape's own distance, so neither is a leaf's raster.
  const auto to_inside = nearest_seed(size, inside), to_outside = nearest_seed(size, outside);
  const std::size_t sx = 1, sy = static_cast<std::size_t>(size.x), sz = sy * static_cast<std::size_t>(size.y);
  const auto slope = [&](std::size_t c, std::size_t stride, int at, int count) {
    const std::size_t up = at + 1 < count ? c + stride : c, down = at > 0 ? c - stride : c;
    const double steps = static_cast<double>((up - down) / stride);
    return steps > 0 ? (static_cast<double>(level[up]) - static_cast<double>(level[down])) / steps : 0.0;
  };
  struct OnSurface {
    Vec3 at, normal;  // leaves from the first one's centre; unit, out of the target
    bool found = false;
  };
  // the surface point nearest to a point `from` that lies within about a leaf of the surface; all in leaves
  const auto on_surface = [&](Vec3 from) {
    OnSurface place;
    const IVec3 c{static_cast<int>(std::clamp(from.x + 0.5, 0.0, size.x - 1.0)), static_cast<int>(std::clamp(from.y + 0.5, 0.0, size.y - 1.0)),
                  static_cast<int>(std::clamp(from.z + 0.5, 0.0, size.z - 1.0))};
    const std::size_t o = static_cast<std::size_t>(c.x) + static_cast<std::size_t>(c.y) * sy + static_cast<std::size_t>(c.z) * sz;
    const Vec3 gradient{slope(o, sx, c.x, size.x), slope(o, sy, c.y, size.y), slope(o, sz, c.z, size.z)};
    const double steepness = length(gradient);
    if (!(steepness > 1e-9)) return place;
    place.normal = gradient / steepness;
    const double here = static_cast<double>(level[o]) + dot(gradient, from - Vec3{double(c.x), double(c.y), double(c.z)});
    const double sink = here / steepness;
    place.found = std::fabs(sink) <= 1.0;
    place.at = from - place.normal * sink;
    return place;
  };
  struct Near {
    float x = 0, y = 0, z = 0;  // place on the surface, leaves
    Wall wall = Wall::opening;  // of the surface's own normal there
    bool found = false;
    [[nodiscard]] Vec3 at() const { return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}; }
  };
  std::vector<Near> nearest(cells);
  i = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, ++i) {
        const std::int32_t other = inside[i] != 0 ? to_outside[i] : to_inside[i];
        if (other < 0) continue;  // the target fills the whole box: no surface anywhere
        const auto o = static_cast<std::size_t>(other);
        const Vec3 here{double(x), double(y), double(z)},
            there{static_cast<double>(o % sy), static_cast<double>(o % sz / sy), static_cast<double>(o / sz)};
        OnSurface place = on_surface(there);
        if (!place.found) place.at = there;
        const OnSurface foot = on_surface(here - place.normal * dot(here - place.at, place.normal));
        if (foot.found && length(here - foot.at) < length(here - place.at)) place = foot;
        const OnSurface own = dot(there - here, there - here) < 4 ? on_surface(here) : OnSurface{};
        if (own.found && length(here - own.at) < length(here - place.at)) place = own;
        const Vec3 normal = length(place.normal) > 0.5 ? place.normal : inside[i] != 0 ? there - here : here - there;
        nearest[i] = {static_cast<float>(place.at.x), static_cast<float>(place.at.y), static_cast<float>(place.at.z), wall_of(normal), true};
      }
  // far from an edge the nearest leaf's place may lie a little along it: neighbours know better ones
  const auto ask = [&](IVec3 at, const std::array<IVec3, 3>& neighbours) {
    const std::size_t c = static_cast<std::size_t>(at.x) + static_cast<std::size_t>(at.y) * sy + static_cast<std::size_t>(at.z) * sz;
    if (!nearest[c].found) return;
    const Vec3 here{double(at.x), double(at.y), double(at.z)};
    double best = dot(here - nearest[c].at(), here - nearest[c].at());
    for (const IVec3 step : neighbours) {
      const IVec3 next = at + step;
      if (next.x < 0 || next.y < 0 || next.z < 0 || next.x >= size.x || next.y >= size.y || next.z >= size.z) continue;
      const std::size_t m = static_cast<std::size_t>(next.x) + static_cast<std::size_t>(next.y) * sy + static_cast<std::size_t>(next.z) * sz;
      if (inside[m] != inside[c]) continue;
      const Vec3 way = here - nearest[m].at();
      if (dot(way, way) >= best) continue;
      best = dot(way, way);
      nearest[c] = nearest[m];
    }
  };
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) ask({x, y, z}, {{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}});
  for (int z = size.z; z-- > 0;)
    for (int y = size.y; y-- > 0;)
      for (int x = size.x; x-- > 0;) ask({x, y, z}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  map.zone_.assign(cells, 0);
  map.wall_.assign(cells, 0);
  map.distance_mm_.assign(cells, 0);
  i = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, ++i) {
        const Near& near = nearest[i];
        const bool in = inside[i] != 0;
        const Vec3 way = Vec3{double(x), double(y), double(z)} - near.at();
        const double d = near.found ? length(way) * leaf : margin_mm;
        map.distance_mm_[i] = static_cast<float>(in ? -d : d);
        map.wall_[i] = static_cast<std::uint8_t>(!near.found || length(way) < 1.5 ? near.wall : wall_of(in ? -way : way));
      }

  // 3. zones, for leaves that hold tissue
  std::vector<std::uint8_t> tissue(cells, k_air);
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    const IVec3 a{std::max(at.x, map.low_.x), std::max(at.y, map.low_.y), std::max(at.z, map.low_.z)};
    const IVec3 b{std::min(at.x + edge, high.x), std::min(at.y + edge, high.y), std::min(at.z + edge, high.z)};
    for (int z = a.z; z < b.z; ++z)
      for (int y = a.y; y < b.y; ++y)
        for (int x = a.x; x < b.x; ++x) tissue[map.index({x, y, z})] = t;
  });
  IVec3 first{1 << 20, 1 << 20, 1 << 20}, last{-1, -1, -1};
  double opening_sum = 0;
  std::uint64_t openings = 0;
  i = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, ++i) {
        if (tissue[i] == k_air) continue;
        const IVec3 at = map.low_ + IVec3{x, y, z};
        const double d = static_cast<double>(map.distance_mm_[i]);
        const bool bottom = static_cast<Wall>(map.wall_[i]) == Wall::floor;
        Zone zone = Zone::none;
        if (inside[i] != 0)
          zone = Zone::target;
        else if (guard != nullptr && guard->distance_mm(map.centre_mm(at)) < 0)
          zone = Zone::protected_;
        else if (d <= (bottom ? spec.leeway.bottom_mm : spec.leeway.sides_mm))
          zone = bottom ? Zone::leeway_bottom : Zone::leeway_sides;
        else if (d <= (bottom ? spec.container.bottom_mm : spec.container.sides_mm))
          zone = bottom ? Zone::container_bottom : Zone::container_sides;
        map.zone_[i] = static_cast<std::uint8_t>(zone);
        ++map.counts_[static_cast<std::size_t>(zone)];
        if (zone == Zone::protected_ && target->distance_mm(map.centre_mm(at)) < 0) ++map.guarded_in_target_;
        if (zone != Zone::target) continue;
        first = {std::min(first.x, at.x), std::min(first.y, at.y), std::min(first.z, at.z)};
        last = {std::max(last.x, at.x), std::max(last.y, at.y), std::max(last.z, at.z)};
        const auto across = [&](int at_axis, int count, std::size_t stride) {
          return (at_axis > 0 && inside[i - stride] == 0) || (at_axis + 1 < count && inside[i + stride] == 0);
        };
        if (across(x, size.x, sx) || across(y, size.y, sy) || across(z, size.z, sz)) ++map.target_border_;
        for (const IVec3 step : k_six_neighbours) map.target_is_open_ = map.target_is_open_ || tree.tissue(at + step) == k_air;
        if (z + 1 == size.z || tissue[i + sz] == k_air) {
          const double surface = maker.surface().value[maker.surface().index(at.x, at.y)];
          if (std::fabs(surface - map.centre_mm(at).z) <= leaf) {
            opening_sum += surface;
            ++openings;
          }
        }
      }
  if (map.count(Zone::target) == 0 && map.guarded_in_target_ > 0)
    throw Error(where, "all of the target is protected", "move the target, or protect less under [[zones.protected]]");
  if (map.count(Zone::target) == 0) throw Error(where, "the target holds no leaf of the tooth '" + tooth.name + "'", "make it larger");
  if (guard != nullptr) map.guard_beyond(tree, *guard);

  // 4. what of each leaf lies in the target: on its border, part by part
  map.target_share_.assign(cells, 0);
  i = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, ++i) {
        const double depth = -static_cast<double>(map.distance_mm_[i]) / leaf;
        if (tissue[i] == k_air || depth < -k_parts_reach_leaves) continue;
        double share = 1;
        if (depth < k_parts_reach_leaves) {
          const LeafParts parts = leaf_parts(map.low_ + IVec3{x, y, z}, [&](IVec3 l) { return -map.distance_mm(l) / leaf; });
          share = 0;
          for (const double p : parts) share += share_beyond(p) / k_parts;
        }
        map.target_share_[i] = static_cast<std::uint16_t>(share * ZoneMap::k_share_units + 0.5);
        map.target_shares_ += map.target_share_[i];
      }
  map.target_low_mm_ = map.centre_mm(first) - Vec3{0.5, 0.5, 0.5} * leaf;
  map.target_high_mm_ = map.centre_mm(last) + Vec3{0.5, 0.5, 0.5} * leaf;
  map.opening_z_mm_ = openings > 0 ? opening_sum / static_cast<double>(openings) : map.target_high_mm_.z;
  return map;
}

}  // namespace cavum
