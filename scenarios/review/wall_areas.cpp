#include "scenarios/review/wall_areas.h"

#include <algorithm>

#include "engine/tooth/adjacent.h"
#include "scenarios/file/bodies.h"
#include "scenarios/zones/relief.h"

namespace cavum::scenarios {
namespace {

/// What lies around a leaf of the target.
class Around {
 public:
  Around(const Tooth& tooth, const Tooth& own, const ZoneMap& zones)
      : all_(tooth.octree),
        tree_(own.octree),
        zones_(zones),
        neighbours_(tissues_of(tooth, TissueKind::neighbour)),
        surface_(surface_relief(own)) {}

  /// The air, behind a wall thinner than `mm`.
  [[nodiscard]] bool air_within(IVec3 from, IVec3 way, double mm) const {
    IVec3 at = from + way;
    if (zones_.zone(at) == Zone::target || tree_.tissue(at) == k_air)
      return false;  // no wall there
    for (double far = zones_.leaf_mm(); far <= mm; far += zones_.leaf_mm()) {
      at = at + way;
      if (tree_.tissue(at) == k_air) return !before_neighbour(at, way);
    }
    return false;
  }
  /// Of the tooth, where a cavity opens.
  [[nodiscard]] bool surface_within(IVec3 at, double mm) const {
    const Facing facing = zones_.facing();
    if (!facing.lateral())
      return surface_.value[surface_.index(at.x, at.y)] - zones_.centre_mm(at).z < mm;
    const IVec3 out = facing.in_tooth({0, 0, 1});
    for (double far = 0; far < mm; far += zones_.leaf_mm(), at = at + out)
      if (!tree_.is_solid(tree_.tissue(at))) return true;
    return false;
  }

 private:
  [[nodiscard]] bool before_neighbour(IVec3 at, IVec3 way) const {
    constexpr double k_gap_mm = 1.0;
    for (double far = 0; far <= k_gap_mm; far += zones_.leaf_mm(), at = at + way)
      if (neighbours_[all_.tissue(at)]) return true;
    return false;
  }
  const Octree &all_, &tree_;
  const ZoneMap& zones_;
  TissueSet neighbours_;
  ColumnMap surface_;
};

}  // namespace

WallAreas hard_walls_mm2(const Tooth& own, const ZoneMap& zones) {
  WallAreas mm2{};
  const Octree& tree = own.octree;
  zones.for_each_target_leaf([&](IVec3 leaf) {
    for (const IVec3 step : k_six_neighbours)
      if (const IVec3 beside = leaf + step;
          zones.zone(beside) != Zone::target && tree.is_solid(tree.tissue(beside)))
        if (const auto wall = static_cast<std::size_t>(zones.wall(beside)); wall < k_walls)
          mm2[wall] += zones.leaf_mm() * zones.leaf_mm();
  });
  return mm2;
}

WallAreas thin_walls_mm2(const ZoneSpec& spec, const Tooth& tooth, const Tooth& own,
                         const ZoneMap& zones) {
  constexpr double k_rim_mm = 0.5;
  const bool has_finish_line =
      std::any_of(spec.target.begin(), spec.target.end(),
                  [](const ShapeSpec& s) { return body_is(s, k_around_stump); });
  const Around around(tooth, own, zones);
  const Facing facing = zones.facing();
  std::array<std::uint64_t, k_walls> thin{};
  zones.for_each_target_leaf([&](IVec3 at) {
    const IVec3 n = own.octree.size();
    if (at.x < 0 || at.y < 0 || at.x >= n.x || at.y >= n.y) return;
    if (!has_finish_line &&
        around.air_within(at, facing.in_tooth({0, 0, -1}), spec.leeway.bottom_mm))
      ++thin[static_cast<std::size_t>(Wall::floor)];
    if (around.surface_within(at, k_rim_mm + spec.leeway.sides_mm)) return;
    for (const IVec3 way : {IVec3{1, 0, 0}, IVec3{-1, 0, 0}, IVec3{0, 1, 0}, IVec3{0, -1, 0}})
      if (around.air_within(at, facing.in_tooth(way), spec.leeway.sides_mm))
        ++thin[static_cast<std::size_t>(wall_of({double(way.x), double(way.y), 0}))];
  });
  WallAreas mm2{};
  for (std::size_t w = 0; w < k_walls; ++w)
    mm2[w] = static_cast<double>(thin[w]) * zones.leaf_mm() * zones.leaf_mm();
  return mm2;
}

}  // namespace cavum::scenarios
