// Bodies that are told by landmarks: where a fissure's outline and a proximal box lie, on landmarks
// written down by hand and on the teeth that ship.
#include "scenarios/zones/placed.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/error.h"
#include "scenarios/zones/outline.h"
#include "scenarios/zones/zone_map.h"
#include "tests/engine/support/basics.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

using testing::dentin_block;
using testing::scenario_text;

OutlineSpec along(double width_mm, double ridge_mm) {
  OutlineSpec o;
  o.kind = OutlineSpec::Kind::fissure;
  o.width_mm = width_mm;
  o.ridge_mm = ridge_mm;
  return o;
}

/// A fissure from x = 2 to x = -2 with a bend of 0.4 mm in the middle; ridges at x = 3 and x =
/// -2.5.
Landmarks bent() {
  Landmarks l;
  for (int i = 0; i <= 40; ++i) {
    const double x = 2.0 - 0.1 * i;
    l.central_fissure_mm.push_back({x, 0.4 * (1 - std::fabs(x) / 2), -0.5});
  }
  l.mesial_ridge.lowest_mm = Vec3{3, 0, 0};
  l.distal_ridge.lowest_mm = Vec3{-2.5, 0, 0};
  return l;
}

TEST(PlacedFissure, FollowsTheLineAndKeepsTheRidges) {
  const OutlineSpec o = place_fissure(along(1.2, 1.0), bent(), Name{"here"});
  ASSERT_EQ(o.paths_mm.size(), 1u);
  const auto outline = make_outline(o, {}, nullptr);
  // the mesial end lies 1.6 mm from the ridge already less 0.6 of width: the distal one is cut back
  // to it
  for (double x = -0.85; x < 1.35; x += 0.05)
    EXPECT_NEAR(outline->distance_mm(x, 0.4 * (1 - std::fabs(x) / 2)), -0.6, 0.05) << x;
  EXPECT_NEAR(length(Vec3{o.paths_mm[0].back().x + 2.5, o.paths_mm[0].back().y, 0}), 1.6, 0.02);
  EXPECT_NEAR(length(Vec3{o.paths_mm[0].front().x - 3, o.paths_mm[0].front().y, 0}), 1.6, 0.02);
}
TEST(PlacedFissure, ThroughARidgeGoesOnBeyondIt) {
  OutlineSpec spec = along(1.2, 1.0);
  spec.through = 1;
  const auto outline = make_outline(place_fissure(spec, bent(), Name{"here"}), {}, nullptr);
  for (double x = 2.0; x < 5.0; x += 0.1) EXPECT_NEAR(outline->distance_mm(x, 0), -0.6, 0.05) << x;
  EXPECT_GT(outline->distance_mm(-2.4, 0), 0);
}
TEST(PlacedFissure, IsRefusedWhereNothingIsLeftOrNoneIsFound) {
  EXPECT_THROW(static_cast<void>(place_fissure(along(1.2, 4.0), bent(), Name{"here"})), Error);
  EXPECT_THROW(static_cast<void>(place_fissure(along(1.2, 1.0), {}, Name{"here"})), Error);
}

TEST(PlacedBox, HasItsAxialWallInsideTheSurfaceAndItsFloorAboveTheNeck) {
  const Tooth block = dentin_block(3.0, 6.0, 0.05);  // its sides at ±3 mm
  Landmarks l;
  for (const double y : {-1.0, 0.0, 1.0})
    l.height_of_contour_mm.push_back({3.0, y, -1.5}), l.neck_mm.push_back({3.0, y, -4.0});
  l.height_of_contour_mm.push_back({-3.0, 0.5, -1.5});
  l.neck_mm.push_back({-3.0, 0.5, -4.0});
  ShapeSpec spec;
  spec.kind = ShapeSpec::Kind::proximal_box;
  spec.width_mm = 2.0;
  spec.depth_mm = 1.5;
  spec.above_neck_mm = 1.0;
  spec.side = -1;
  const ShapeSpec box = place_proximal_box(spec, block, l, Name{"here"});
  EXPECT_EQ(box.kind, ShapeSpec::Kind::box);
  EXPECT_NEAR(box.at_mm.x + 0.5 * box.size_mm.x, -1.5, 0.03);  // axial wall
  EXPECT_NEAR(box.at_mm.z - 0.5 * box.size_mm.z, -3.0, 1e-9);  // floor
  EXPECT_NEAR(box.at_mm.y, 0.5, 1e-9);
  EXPECT_NEAR(box.size_mm.y, 2.0, 1e-9);
  EXPECT_LT(box.at_mm.x - 0.5 * box.size_mm.x, -3.5);
  spec.above_neck_mm = 5.0;
  EXPECT_THROW(static_cast<void>(place_proximal_box(spec, block, l, Name{"here"})), Error);
  EXPECT_THROW(static_cast<void>(place_proximal_box(spec, block, {}, Name{"here"})), Error);
}

/// On a tooth that ships: the target lies along the fissure's line, and its floor below enamel as
/// asked.
TEST(PlacedFissure, OnTheMolarThatShipsAFloorLiesInDentinByWhatIsAsked) {
  const Tooth molar = load_tooth_file(testing_basics::data_path("teeth/lower_molar.cvt"));
  const Landmarks l = find_landmarks(molar);
  ASSERT_GE(l.central_fissure_mm.size(), 2u);
  const ZoneMap zones = build_zones(
      parse_scenario(
          scenario_text(
              "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"fissure\", width_mm = 1.4 }\n"
              "bottom = { kind = \"below_border\", depth_mm = 0.3 }\n"),
          "s.toml"),
      molar);
  double border_mm = 1e9;  // enamel's lowest leaf under the line, counted leaf by leaf
  int beside = 0;
  for (const Vec3& p : l.central_fissure_mm) {
    Vec3 at = p;
    while (molar.octree.tissue_at(at) != molar.tissue_id("dentin")) at.z -= 0.025;
    border_mm = std::min(border_mm, at.z);
    beside += zones.zone(molar.octree.leaf_at({p.x, p.y, p.z - 0.3})) == Zone::target ? 0 : 1;
  }
  EXPECT_NEAR(zones.target_low_mm().z, border_mm - 0.3,
              0.11);  // a leaf each, and the relief is smoothed
  EXPECT_LT(beside,
            static_cast<int>(l.central_fissure_mm.size()) / 2);  // its ends stay with the ridges
}

}  // namespace
}  // namespace cavum::scenarios
