#include "grading/measures/access.h"

#include <gtest/gtest.h>

#include "engine/tooth/octree_edit.h"
#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

using testing::box_hole;
using testing::Carved;
using testing::chambered_block;
using testing::dentin_block;
using testing::k_chamber_target;
using testing::opening_pulp;
using testing::scenario_text;

TEST(Access, AWholeRoofTakenOffLeavesNothingOverChamberAndCanals) {
  Carved c(opening_pulp(k_chamber_target), chambered_block(0.05));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -4.5), 0);
  const AccessMeasures a = c.graded().access;
  ASSERT_TRUE(a.overhang);
  EXPECT_EQ(a.overhang->mm3, 0);
  ASSERT_TRUE(a.canals_covered_percent);
  EXPECT_EQ(*a.canals_covered_percent, 0);
  EXPECT_EQ(a.floor_cut.mm3, 0);
}

TEST(Access, AStripOfRoofLeftHasItsVolumeAndCoversOneCanalOfTwo) {
  Carved c(opening_pulp(k_chamber_target), chambered_block(0.05));
  c.carve(
      box_hole(-1.5, 0.5, -1, 1, -4.5),
      0);  // 1 mm of the roof stays: 3 mm of dentin and enamel, less the horn of 0.5 x 0.6 x 0.5 mm
  const Result r = c.graded();
  ASSERT_TRUE(r.access.overhang);
  EXPECT_NEAR(r.access.overhang->mm3, 1.0 * 2.0 * 3.0 - 0.15, r.access.overhang->bound_mm3);
  EXPECT_LT(r.access.overhang->bound_mm3, 0.07);
  EXPECT_NEAR(r.access.overhang_middle_mm.x, 1.0, 0.05);
  EXPECT_NEAR(*r.access.canals_covered_percent, 50, 1e-9);
  EXPECT_NEAR(*metric_value(r, "overhang_mm3").value, r.access.overhang->mm3, 0);
}

TEST(Access, UndercutRoofIsOverhangAlthoughTheChamberBelowItIsEmpty) {
  Carved c(opening_pulp(k_chamber_target), chambered_block(0.05));
  c.carve(box_hole(-1.5, 0.5, -1, 1, -4.5), 0);
  c.carve(
      [](Vec3 p) {
        return std::max({std::fabs(p.x) - 1.5, std::fabs(p.y) - 1.0, std::fabs(p.z + 3.75) - 0.75});
      },
      1);
  const AccessMeasures a = c.graded().access;
  EXPECT_NEAR(a.overhang->mm3, 5.85, a.overhang->bound_mm3);
  EXPECT_NEAR(*a.canals_covered_percent, 50, 1e-9);
}

TEST(Access, OnlyHardTissueBelowTheTargetCountsAsFloorCut) {
  Carved c(opening_pulp(k_chamber_target), chambered_block(0.05));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -4.5), 0);
  c.carve(box_hole(-1.4, -0.4, -0.5, 0.5, -4.8),
          3);  // 0.3 mm of floor under 1 mm2, of which the canal takes 0.4 x 0.6
  const Result r = c.graded();
  EXPECT_NEAR(r.access.floor_cut.mm3, 0.3 * (1.0 - 0.24), r.access.floor_cut.bound_mm3);
  EXPECT_EQ(r.access.floor_first.tick, 3);
}

TEST(Access, WithoutAnAimThereIsNothingToOverhang) {
  Carved c(scenario_text(k_chamber_target), chambered_block(0.1));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -4.5), 0);
  const Result r = c.graded();
  EXPECT_FALSE(r.access.overhang);
  EXPECT_FALSE(metric_value(r, "overhang_mm3").value);
  EXPECT_FALSE(metric_value(r, "canals_covered_percent").value);
}

TEST(Access, ATargetsTaperIsThatOfItsShapeAndAStraightHoleIsOffByIt) {
  const std::string cone =
      "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"circle\", radius_mm = 1.5 }\nbottom = { kind = \"level\", z_mm = -2 }\n"
      "taper_deg = 8\n";
  Carved c(scenario_text(cone), dentin_block(4, 4, 0.05));
  c.carve(testing::round_hole(0, 0, 1.5, -2), 0);
  const Result r = c.graded();
  ASSERT_TRUE(r.access.target_taper_deg);
  EXPECT_NEAR(*r.access.target_taper_deg, 8, 1);
  EXPECT_NEAR(*metric_value(r, "taper_error_deg").value, 8, 1.5);
}

// A target that leans: the roof is above along its axis, not along z.
TEST(Access, LooksAlongTheAxisOfALeaningTarget) {
  const std::string leaning =
      "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -2.2]\nsize_mm = [2.4, 1.4, 5.4]\naxis = [0.3, 0, 0.95394]\n";
  Carved c(opening_pulp(leaning), chambered_block(0.05));
  EXPECT_NEAR(c.zones.approach().x, 0.3, 1e-4);
  const AccessMeasures whole = c.graded().access;
  // nothing removed: overhang is what of the target lies above pulp along the axis, counted here
  // point by point
  double points = 0;
  const Vec3 up = c.zones.approach();
  c.zones.for_each_target_leaf([&](IVec3 leaf) {
    const Vec3 p = c.zones.centre_mm(leaf);
    if (!c.before.octree.is_solid(c.before.octree.tissue_at(p))) return;
    bool above = false;
    for (double down = 0; down < 6; down += 0.01) {
      const IVec3 at = c.before.octree.leaf_at(p - up * down);
      if (c.zones.zone(at) != scenarios::Zone::target) break;
      above = above || c.before.octree.tissue(at) == k_pulp;
    }
    points += above ? 1 : 0;
  });
  ASSERT_TRUE(whole.overhang);
  EXPECT_GT(whole.overhang->mm3, 2);
  EXPECT_NEAR(whole.overhang->mm3, points * c.zones.leaf_volume_mm3(), 0.02 * whole.overhang->mm3);
}

}  // namespace
}  // namespace cavum::grading
