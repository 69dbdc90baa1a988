// A cavity in a crown's side, on a round tooth whose surface is known: where its axial wall lies,
// that its outline bends with the neck, and which wall is which.
#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "scenarios/zones/placed.h"
#include "scenarios/zones/zone_map.h"
#include "tests/scenarios/test_crowns.h"

namespace cavum::scenarios {
namespace {

using testing::round_landmarks;
using testing::round_tooth;
using testing::scenario_text;

constexpr double k_side_radius_mm = 4, k_side_neck_mm = -5, k_depth_mm = 1.2, k_side_leaf_mm = 0.05;

ZoneMap cavity(const std::string& more, const Landmarks& landmarks,
               const std::string& side = "buccal") {
  return build_zones(
      parse_scenario(scenario_text("[[zones.target]]\nshape = \"side_cavity\"\nside = \"" + side +
                                   "\"\ndepth_mm = 1.2\n" + more),
                     "s.toml"),
      round_tooth(k_side_radius_mm, -6, k_side_leaf_mm), landmarks);
}

constexpr const char* k_box =
    "outline = { kind = \"polygon\", points_mm = [[-2, 1], [2, 1], [2, 3], [-2, 3]] }\n";

TEST(SideCavity, ItsAxialWallFollowsTheSurfaceAtItsDepth) {
  const ZoneMap zones = cavity(k_box, round_landmarks(k_side_radius_mm, k_side_neck_mm));
  EXPECT_LT(length(zones.approach() - Vec3{0, 1, 0}), 1e-9);
  const double axial = k_side_radius_mm - k_depth_mm;
  double worst = 0;
  for (double x = -1.3; x <= 1.3; x += 0.13)
    for (const double z : {-3.5, -3.0, -2.5}) {
      const Vec3 way = normalized({x, std::sqrt(axial * axial - x * x), 0});
      worst = std::max(worst, std::fabs(zones.distance_mm(way * axial + Vec3{0, 0, z})));
    }
  EXPECT_LT(worst, 0.5 * k_side_leaf_mm);
  EXPECT_GT(zones.count(Zone::target), 1000u);
}

TEST(SideCavity, HasTheVolumeOfTheRingThatItIs) {
  // of the ring between both radii, what lies over the outline: integrated over x
  const ZoneMap zones = cavity(k_box, round_landmarks(k_side_radius_mm, k_side_neck_mm));
  const double inner = k_side_radius_mm - k_depth_mm;
  double mm2 = 0;
  for (double x = -1.9995; x < 2; x += 0.001)
    mm2 += 0.001 * (std::sqrt(k_side_radius_mm * k_side_radius_mm - x * x) -
                    std::sqrt(inner * inner - x * x));
  const double mm3 =
      static_cast<double>(zones.target_shares()) / ZoneMap::k_share_units * zones.leaf_volume_mm3();
  EXPECT_NEAR(mm3, 2 * mm2, 0.01 * 2 * mm2);
}

TEST(SideCavity, ItsWallsAreToldAsSeenFromTheSide) {
  const ZoneMap zones = cavity(k_box, round_landmarks(k_side_radius_mm, k_side_neck_mm));
  const Tooth tooth = round_tooth(k_side_radius_mm, -6, k_side_leaf_mm);
  const Octree& tree = tooth.octree;
  const auto wall = [&](Vec3 p) { return wall_name(zones.wall(tree.leaf_at(p)), zones.facing()); };
  EXPECT_STREQ(wall({0, 2.5, -3}), "floor");
  EXPECT_STREQ(wall({2.3, 2.9, -3}), "mesial");
  EXPECT_STREQ(wall({-2.3, 2.9, -3}), "distal");
  EXPECT_STREQ(wall({0, 3.4, -1.7}), "occlusal");
  EXPECT_STREQ(wall({0, 3.4, -4.3}), "gingival");
  EXPECT_EQ(zones.zone(tree.leaf_at({0, 2.75, -3})), Zone::leeway_bottom);
  EXPECT_EQ(zones.zone(tree.leaf_at({0, 3.4, -1.9})), Zone::leeway_sides);
  EXPECT_NEAR(zones.opening_z_mm(), 3.826, 0.04);  // the mean of sqrt(16 - x²) between -2 and 2
}

TEST(SideCavity, BendsWithTheNeckUnlessHeightsAreLevel) {
  const Landmarks wavy =
      round_landmarks(k_side_radius_mm, k_side_neck_mm, 2.0);  // the neck rises by 2 (x/4)²
  const ZoneMap bent = cavity(k_box, wavy),
                level = cavity(std::string("heights = \"level\"\n") + k_box, wavy);
  for (const double x : {-1.6, 0.0, 1.6}) {
    const double rise = 2.0 * x * x / 16, y = std::sqrt(3.4 * 3.4 - x * x);
    // the level of the gingival wall: where the distance changes its sign going up
    const auto foot = [&](const ZoneMap& zones) {
      double z = -4.8;
      while (z < -1 && zones.distance_mm(Vec3{x, y, z}) > 0) z += 0.005;
      return z;
    };
    EXPECT_NEAR(foot(bent), k_side_neck_mm + 1 + rise, 0.03) << x;
    EXPECT_NEAR(foot(level), k_side_neck_mm + 1, 0.03) << x;
  }
}

TEST(SideCavity, FromLingualIsTheMirrorImage) {
  const Landmarks l = round_landmarks(k_side_radius_mm, k_side_neck_mm);
  const ZoneMap buccal = cavity(k_box, l), lingual = cavity(k_box, l, "lingual");
  EXPECT_LT(length(lingual.approach() - Vec3{0, -1, 0}), 1e-9);
  EXPECT_EQ(buccal.count(Zone::target), lingual.count(Zone::target));
  for (const Zone z : {Zone::leeway_sides, Zone::leeway_bottom, Zone::container_sides,
                       Zone::container_bottom})  // ties at 45 degrees fall either way
    EXPECT_NEAR(static_cast<double>(buccal.count(z)), static_cast<double>(lingual.count(z)),
                0.02 * static_cast<double>(buccal.count(z)));
  for (const double y : {2.5, 2.8, 3.3, 3.9})
    EXPECT_NEAR(buccal.distance_mm(Vec3{0.3, y, -3}), lingual.distance_mm(Vec3{0.3, -y, -3}), 1e-3)
        << y;
}

TEST(SideCavity, IsRefusedWithoutANeck) {
  EXPECT_THROW(static_cast<void>(cavity(k_box, {})), Error);
}

}  // namespace
}  // namespace cavum::scenarios
