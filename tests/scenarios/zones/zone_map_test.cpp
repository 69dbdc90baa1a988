#include "scenarios/zones/zone_map.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <numbers>

#include "scenarios/zones/relief.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

using testing::chambered_block;
using testing::dentin_block;
using testing::scenario_text;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double k_patience = 10;  // how much slower a program may be that watches itself
#else
constexpr double k_patience = 1;
#endif

ZoneMap zones_of(const Tooth& tooth, const std::string& target) {
  return build_zones(parse_scenario(scenario_text(target), "test.toml"), tooth);
}

std::string cylinder(double radius, double depth) {
  return "[[zones.target]]\nshape = \"cylinder\"\nat_mm = [0.011, -0.017, " +
         std::to_string(-depth) + "]\nradius_mm = " + std::to_string(radius) + "\nheight_mm = 5\n";
}

TEST(ZoneMap, VolumesOfKnownShapesAreWithinHalfAPercent) {
  const Tooth block = dentin_block(4, 5, 0.05);
  EXPECT_NEAR(zones_of(block, cylinder(1.5, 3)).target_mm3(), std::numbers::pi * 1.5 * 1.5 * 3,
              0.005 * std::numbers::pi * 1.5 * 1.5 * 3);
  const auto box = zones_of(
      block,
      "[[zones.target]]\nshape = \"box\"\nat_mm = [0.01, 0.02, -1]\nsize_mm = [3, 2, 4]\nturn_deg = 30\n");
  EXPECT_NEAR(box.target_mm3(), 3 * 2 * 3, 0.005 * 18);
  const auto cone = zones_of(
      block,
      "[[zones.target]]\nshape = \"cone\"\nat_mm = [0.01, 0, -3]\nradius_mm = 0.8\ntop_radius_mm = 1.6\nheight_mm = 3\n");
  const double cone_mm3 = std::numbers::pi * 3 / 3 * (0.8 * 0.8 + 0.8 * 1.6 + 1.6 * 1.6);
  EXPECT_NEAR(cone.target_mm3(), cone_mm3, 0.005 * cone_mm3);
  const auto ball = zones_of(
      block, "[[zones.target]]\nshape = \"ball\"\nat_mm = [0.013, 0.007, -2.5]\nradius_mm = 1.5\n");
  const double ball_mm3 = 4.0 / 3 * std::numbers::pi * 1.5 * 1.5 * 1.5;
  EXPECT_NEAR(ball.target_mm3(), ball_mm3, 0.005 * ball_mm3);
  const auto stroke = zones_of(
      block,
      "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"stroke\", points_mm = [[-1.5, 0], [1.5, 0]], width_mm = 1.4 }\n"
      "bottom = { kind = \"below_lowest\", depth_mm = 1.8 }\n");
  const double stroke_mm3 = (3 * 1.4 + std::numbers::pi * 0.49) * 1.8;
  EXPECT_NEAR(stroke.target_mm3(), stroke_mm3, 0.005 * stroke_mm3);
}

TEST(ZoneMap, TaperWidensTheColumnTowardsTheOpening) {
  const Tooth block = dentin_block(4, 5, 0.05);
  const auto z = zones_of(
      block,
      "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"circle\", radius_mm = 1 }\nbottom = { kind = \"level\", z_mm = -2 }\n"
      "taper_deg = 10\n");
  const double top = 1 + 2 * std::tan(10 * std::numbers::pi / 180),
               want = std::numbers::pi * 2 / 3 * (1 + top + top * top);
  EXPECT_NEAR(z.target_mm3(), want, 0.005 * want);
}

TEST(ZoneMap, DistancesAreTrueToHalfALeafEverywhere) {
  const double leaf = 0.05, bound = k_distance_bound_leaves * leaf;
  const Tooth block = dentin_block(4, 5, leaf);
  const Vec3 middle{0.013, 0.007, -2.5};
  const auto ball = zones_of(
      block, "[[zones.target]]\nshape = \"ball\"\nat_mm = [0.013, 0.007, -2.5]\nradius_mm = 1.5\n");
  double worst = 0;
  ball.for_each_leaf([&](IVec3 l, Zone) {
    worst = std::max(worst,
                     std::fabs(ball.distance_mm(l) - (length(ball.centre_mm(l) - middle) - 1.5)));
  });
  std::cout << "worst error " << worst / leaf << " leaves\n";
  EXPECT_LT(worst, bound);

  // a box has edges and corners, where a distance is easily wrong; it is open to the top
  const auto box = zones_of(
      block,
      "[[zones.target]]\nshape = \"box\"\nat_mm = [0.01, 0.02, 0]\nsize_mm = [3, 2, 4]\nturn_deg = 20\n");
  const double c = std::cos(20 * std::numbers::pi / 180), s = std::sin(20 * std::numbers::pi / 180);
  worst = 0;
  box.for_each_leaf([&](IVec3 l, Zone) {
    const Vec3 p = box.centre_mm(l) - Vec3{0.01, 0.02, 0};
    const Vec3 q{c * p.x + s * p.y, c * p.y - s * p.x, p.z};
    if (p.z > 0) return;
    const double dx = std::fabs(q.x) - 1.5, dy = std::fabs(q.y) - 1, dz = std::fabs(q.z) - 2;
    const double inside = std::max({dx, dy, dz});
    const double truth =
        inside <= 0 ? inside : length({std::max(dx, 0.0), std::max(dy, 0.0), std::max(dz, 0.0)});
    worst = std::max(worst, std::fabs(box.distance_mm(l) - truth));
  });
  std::cout << "worst error " << worst / leaf << " leaves\n";
  EXPECT_LT(worst, bound);
}

TEST(ZoneMap, SidesBottomLeewayAndContainerFollowTheWrittenRule) {
  const Tooth block = dentin_block(4, 5, 0.05);
  const auto z = zones_of(block, cylinder(1.5, 3));
  const auto at = [&](double x, double y, double zz) {
    return z.zone(block.octree.leaf_at({x, y, zz}));
  };
  EXPECT_EQ(at(0, 0, -2.9), Zone::target);
  EXPECT_EQ(at(1.62, 0, -1), Zone::leeway_sides);
  EXPECT_EQ(at(2.0, 0, -1), Zone::container_sides);
  EXPECT_EQ(at(2.5, 0, -1), Zone::none);
  EXPECT_EQ(at(0, 0, -3.2), Zone::leeway_bottom);
  EXPECT_EQ(at(0, 0, -3.5), Zone::container_bottom);
  EXPECT_EQ(at(0, 0, -3.9), Zone::none);
  EXPECT_EQ(at(1.9, 0, -3.2),
            Zone::container_sides);  // below the floor, but more beside than under
  EXPECT_EQ(at(1.6, 0, -3.4), Zone::container_bottom);  // more under than beside
  EXPECT_EQ(z.wall(block.octree.leaf_at({2.0, 0.1, -1})), Wall::mesial);
  EXPECT_EQ(z.wall(block.octree.leaf_at({-2.0, 0.1, -1})), Wall::distal);
  EXPECT_EQ(z.wall(block.octree.leaf_at({0.1, 2.0, -1})), Wall::buccal);
  EXPECT_EQ(z.wall(block.octree.leaf_at({0.1, -1.3, -1})), Wall::lingual);
  EXPECT_EQ(z.wall(block.octree.leaf_at({0.1, 0, -2.9})), Wall::floor);
  EXPECT_NEAR(z.opening_z_mm(), 0, 0.026);
}

TEST(ZoneMap, WhatIsProtectedIsSoWhereverItLies) {
  const Tooth block = dentin_block(4, 5, 0.05);
  const auto z = zones_of(
      block,
      cylinder(1.5, 3) +
          "[[zones.protected]]\nshape = \"box\"\nat_mm = [2.7, 0, -2.5]\nsize_mm = [2.6, 8, 5]\n");
  EXPECT_EQ(z.zone(block.octree.leaf_at({1.35, 0, -1})), Zone::target);
  EXPECT_EQ(z.zone(block.octree.leaf_at({1.45, 0, -1})),
            Zone::protected_);  // taken out of the target
  EXPECT_EQ(z.zone(block.octree.leaf_at({1.6, 0, -1})), Zone::protected_);  // in the leeway
  EXPECT_EQ(z.zone(block.octree.leaf_at({2.1, 0, -1})), Zone::protected_);  // in the container
  EXPECT_EQ(z.zone(block.octree.leaf_at({2.4, 0, -1})), Zone::protected_);  // just beyond it
  EXPECT_EQ(z.zone(block.octree.leaf_at({3.9, 3.9, -4.9})), Zone::protected_);
  EXPECT_EQ(z.zone(block.octree.leaf_at({3.9, 3.9, 0.1})), Zone::none);  // air
  EXPECT_EQ(z.zone(block.octree.leaf_at({-3.9, 3.9, -4.9})), Zone::none);
  EXPECT_NEAR(static_cast<double>(z.count(Zone::protected_)) * z.leaf_volume_mm3(), 2.6 * 8 * 5,
              0.5);
  EXPECT_GT(z.guarded_in_target(), 0u);
  EXPECT_NEAR(z.distance_mm(Vec3{1.2, 0, -1}), -0.2,
              0.03);  // the target ends where the protection begins
  EXPECT_EQ(z.zone(block.octree.leaf_at({-1.6, 0, -1})), Zone::leeway_sides);
}

TEST(ZoneMap, ShapesAreAddedSubtractedAndIntersectedInOrder) {
  const Tooth block = dentin_block(4, 5, 0.05);
  const auto z = zones_of(
      block,
      cylinder(1.5, 3) +
          "[[zones.target]]\ncombine = \"subtract\"\nshape = \"box\"\nat_mm = [0, 0, -1.5]\nsize_mm = [0.5, 0.5, 4]\n" +
          "[[zones.target]]\ncombine = \"intersect\"\nshape = \"box\"\nat_mm = [0, 0, 0]\nsize_mm = [8, 8, 4]\n");
  const double want = (std::numbers::pi * 2.25 - 0.25) * 2;
  EXPECT_NEAR(z.target_mm3(), want, 0.005 * want);
}

TEST(Relief, FindsTheChamberAboveTheCanals) {
  const Tooth tooth = chambered_block(0.05);
  const auto chamber = tissue_relief(tooth, "pulp", TissuePart::chamber, Name{"test"});
  EXPECT_NEAR(chamber.lowest_mm, -4.5, 0.051);
  EXPECT_NEAR(chamber.highest_mm, -2.5, 1e-9);
  EXPECT_NEAR(chamber.middle_mm.x, 0, 0.01);
  EXPECT_NEAR(tissue_relief(tooth, "pulp", TissuePart::all, Name{"test"}).lowest_mm, -6.5, 1e-9);
  EXPECT_THROW(static_cast<void>(
                   tissue_relief(dentin_block(1, 1, 0.1), "pulp", TissuePart::all, Name{"test"})),
               Error);
}

TEST(ZoneMap, ColumnOverTheChamberFollowsItsShadowDownToItsFloor) {
  const Tooth tooth = chambered_block(0.05);
  const auto z = zones_of(
      tooth,
      "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"projection\", tissue = \"pulp\", part = \"chamber\", offset_mm = 0.1 }\n"
      "bottom = { kind = \"tissue_floor\", tissue = \"pulp\", part = \"chamber\" }\n");
  const double area = 3 * 2 + 2 * 0.1 * 5 + std::numbers::pi * 0.01, want = area * 4.5;
  EXPECT_NEAR(z.target_mm3(), want, 0.02 * want);  // a shadow is known to half a leaf
  EXPECT_EQ(z.zone(tooth.octree.leaf_at({0, 0, -4.4})), Zone::target);
  EXPECT_EQ(z.zone(tooth.octree.leaf_at({0, 0, -4.6})), Zone::leeway_bottom);
  EXPECT_EQ(z.zone(tooth.octree.leaf_at({1.0, 0, -5.0})),
            Zone::container_bottom);  // a canal is not target
}

TEST(ZoneMap, SaysWhenTheTargetMissesTheTooth) {
  const Tooth block = dentin_block(2, 2, 0.1);
  EXPECT_THROW(
      static_cast<void>(zones_of(
          block, "[[zones.target]]\nshape = \"ball\"\nat_mm = [50, 0, 0]\nradius_mm = 1\n")),
      Error);
}

TEST(ZoneMap, ShippedScenariosFitTheShippedMolarInTime) {
  const std::string data = std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/";
  const Tooth tooth =
      load_tooth_file(std::string(CAVUM_SOURCE_DIR) + "/data/teeth/lower_molar.cvt");
  for (const char* name : {"molar_access.toml", "class_1.toml"}) {
    const Scenario s = load_scenario(data + name);
    const std::clock_t start = std::clock();
    const ZoneMap z = build_zones(s, tooth);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    RecordProperty(name, std::to_string(seconds));
    EXPECT_LT(seconds, 6.0 * k_patience)
        << name;  // of one processor; 2 s on an idle machine of the exam, tests share theirs
    EXPECT_GT(z.target_mm3(), 5) << name;
    EXPECT_GT(z.count(Zone::protected_), 0u) << name;
  }
}

}  // namespace
}  // namespace cavum::scenarios
