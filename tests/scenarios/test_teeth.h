// Small teeth and scenarios of known geometry, made in memory. Shared by the tests of scenarios and
// grading.
#pragma once

#include <string>

#include "engine/tooth/tooth.h"
#include "scenarios/file/parse.h"

namespace cavum::testing {

/// A grid with a tissue given by `label(centre_mm)` and the distance by `distance_mm(centre_mm)`
/// (to solid tissue).
template <class Label, class Distance>
Tooth make_tooth(Vec3 low_mm, Vec3 high_mm, double leaf_mm, const Label& label,
                 const Distance& distance_mm) {
  TissueGrid grid;
  const auto leaves = [&](double length) {
    return static_cast<std::int32_t>(length / leaf_mm + 0.5);
  };
  grid.allocate(
      {leaves(high_mm.x - low_mm.x), leaves(high_mm.y - low_mm.y), leaves(high_mm.z - low_mm.z)},
      leaf_mm, low_mm);
  for (int z = 0; z < grid.size.z; ++z)
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x) {
        const auto i = grid.index({x, y, z});
        const Vec3 at = grid.centre_mm({x, y, z});
        grid.tissue[i] = label(at);
        grid.distance[i] = encode_distance(distance_mm(at) / leaf_mm);
      }
  Tooth tooth;
  tooth.name = "test tooth";
  grid.make_consistent(tooth.tissues);
  tooth.octree = Octree(grid, tooth.tissues);
  return tooth;
}

/// A block of dentin, top at z = 0, `half_mm` wide to every side, `depth_mm` deep, with a
/// millimetre of air above.
inline Tooth dentin_block(double half_mm, double depth_mm, double leaf_mm) {
  return make_tooth(
      {-half_mm, -half_mm, -depth_mm}, {half_mm, half_mm, 1.0}, leaf_mm,
      [](Vec3 p) { return p.z < 0 ? k_dentin : k_air; }, [](Vec3 p) { return p.z; });
}

/// A block with a flat pulp chamber (box 3 x 2 x 1.5 mm, its floor at z = -4.5), two horns on its
/// roof, two canals below it, and periodontium under z = -6.5.
inline Tooth chambered_block(double leaf_mm) {
  // boxes of pulp: chamber, horns, canals; the latter reach into the chamber, so that no surface
  // lies between them
  constexpr Vec3 k_pulp_boxes[][2]{{{-1.5, -1, -4.5}, {1.5, 1, -3}},
                                   {{-1.4, -0.3, -3.7}, {-0.9, 0.3, -2.5}},
                                   {{0.9, -0.3, -3.7}, {1.4, 0.3, -2.5}},
                                   {{-1.2, -0.3, -6.5}, {-0.8, 0.3, -3.7}},
                                   {{0.8, -0.3, -6.5}, {1.2, 0.3, -3.7}}};
  const auto into_pulp = [k_pulp_boxes](Vec3 p) {  // how deep in it, negative outside
    double deepest = -9;
    for (const auto& [low, high] : k_pulp_boxes) {
      const Vec3 out{std::max(low.x - p.x, p.x - high.x), std::max(low.y - p.y, p.y - high.y),
                     std::max(low.z - p.z, p.z - high.z)};
      const double most = std::max({out.x, out.y, out.z});
      deepest =
          std::max(deepest, most < 0 ? -most
                                     : -length(Vec3{std::max(out.x, 0.0), std::max(out.y, 0.0),
                                                    std::max(out.z, 0.0)}));
    }
    return deepest;
  };
  return make_tooth(
      {-4, -3.5, -7.5}, {4, 3.5, 0.5}, leaf_mm,
      [into_pulp](Vec3 p) -> std::uint8_t {
        if (p.z > 0) return k_air;
        if (p.z < -6.5) return k_periodontium;
        return into_pulp(p) > 0 ? k_pulp : p.z > -1.5 ? k_enamel : k_dentin;
      },
      [into_pulp](Vec3 p) {
        return std::max({p.z, -6.5 - p.z, into_pulp(p)});
      });
}

/// A whole scenario around the given [[zones.target]] text.
inline std::string scenario_text(const std::string& target, const std::string& more = "") {
  return R"(id = "test"
title = "Test"
tooth = "none.cvt"
burs = ["round-1.0"]
max_rpm = 200000
time_limit_s = 10
[[steps]]
id = "only"
instruction = "Cut."
complete_when = "target_removed_percent >= 99"
[perforation]
aims = []
faults = ["pulp", "periodontium"]
[zones.leeway]
sides_mm = 0.2
bottom_mm = 0.3
[zones.container]
sides_mm = 0.8
bottom_mm = 0.7
)" + target +
         R"(
[rubric]
rule = "compensatory"
pass_percent = 60
borderline_percent = 2
[[rubric.criteria]]
id = "removed"
metric = "target_removed_percent"
full = 100
zero = 50
points = 60
[[rubric.criteria]]
id = "sides"
metric = "container_sides_mm3"
full = 0
zero = 5
points = 20
[[rubric.criteria]]
id = "outside"
metric = "outside_mm3"
full = 0
zero = 5
points = 20
)" + more;
}

}  // namespace cavum::testing
