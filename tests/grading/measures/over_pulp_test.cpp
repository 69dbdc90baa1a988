// What is left over the pulp, against closed forms: cavities of known shape over a pulp that is a
// ball or a box.
#include "grading/measures/over_pulp.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/tooth/octree_edit.h"
#include "grading/feedback/why.h"
#include "grading/result/result_json.h"
#include "scenarios/file/rubric_check.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

using testing::box_hole;
using testing::Carved;
using testing::dentin_block;
using testing::make_tooth;
using testing::round_hole;
using testing::scenario_text;

constexpr double k_leaf_mm = 0.05;

/// A block of dentin, top at z = 0, with a pulp of this shape (signed distance, negative inside).
template <class Shape>
Tooth with_pulp(const Shape& pulp) {
  return make_tooth(
      {-3, -3, -6}, {3, 3, 0.5}, k_leaf_mm,
      [&](Vec3 p) { return p.z > 0       ? k_air
                           : pulp(p) < 0 ? k_pulp
                                         : k_dentin; },
      [&](Vec3 p) { return std::max(p.z, -pulp(p)); });
}

/// A ball of radius 1, its top 2.5 mm below the surface.
double pulp_ball(Vec3 p) { return length(p - Vec3{0, 0, -3.5}) - 1.0; }
double box(Vec3 p) {
  return std::max({std::fabs(p.x) - 0.8, std::fabs(p.y) - 0.8, std::fabs(p.z + 3.0) - 0.8});
}

std::string asking(
    const std::string& target =
        "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -0.5]\nsize_mm = [1, 1, 1]\n") {
  return scenario_text(
      target,
      "[[rubric.criteria]]\nid = \"left\"\nmetric = \"dentin_over_pulp_mm\"\nfull = 1.2\nzero = 0.2\npoints = 10\ncritical_below = 0.1\n");
}

TEST(OverPulp, AFloorOverABallLeavesWhatLiesBetweenThem) {
  Carved c(asking(), with_pulp(pulp_ball));
  c.carve(round_hole(0, 0, 0.5, -1.0), 3);
  c.carve(round_hole(0, 0, 0.4, -1.7), 7);
  const OverPulpMeasures m = c.graded().over_pulp;
  ASSERT_TRUE(m.dentin_mm);
  EXPECT_NEAR(*m.dentin_mm, 2.5 - 1.7, m.bound_mm);
  EXPECT_DOUBLE_EQ(m.bound_mm, k_leaf_mm);
  EXPECT_EQ(m.thinnest.tick, 7);
  EXPECT_NEAR(m.thinnest.site_mm.z, -1.7, k_leaf_mm);
  EXPECT_NEAR(length(m.pulp_mm - Vec3{0, 0, -2.5}), 0.0, 0.15);
}

TEST(OverPulp, BesideTheBallTheNearestEdgeOfTheFloorCounts) {
  Carved c(asking(), with_pulp(pulp_ball));
  c.carve(round_hole(1.5, 0, 0.5, -1.5), 0);
  const OverPulpMeasures m = c.graded().over_pulp;
  EXPECT_NEAR(*m.dentin_mm, std::sqrt(1.0 * 1.0 + 2.0 * 2.0) - 1.0,
              m.bound_mm);  // from the rim at x = 1, z = -1.5 to the middle
  EXPECT_NEAR(m.thinnest.site_mm.x, 1.0, 2 * k_leaf_mm);
}

TEST(OverPulp, AWallBesideABoxCountsAsAFloorDoes) {
  Carved c(asking(), with_pulp(box));
  c.carve(box_hole(1.2, 2.0, -0.5, 0.5, -3.0), 0);  // 0.4 mm beside the pulp, as deep as its middle
  EXPECT_NEAR(*c.graded().over_pulp.dentin_mm, 0.4, k_leaf_mm);
  c.carve(box_hole(-0.5, 0.5, -0.5, 0.5, -1.9), 5);  // 0.3 mm above it
  const OverPulpMeasures m = c.graded().over_pulp;
  EXPECT_NEAR(*m.dentin_mm, 0.3, k_leaf_mm);
  EXPECT_EQ(m.thinnest.tick, 5);
}

TEST(OverPulp, NeverMoreWhenMoreIsCutAndNothingFromTheTickInWhichThePulpIsOpened) {
  Carved c(asking(), with_pulp(pulp_ball));
  double before = 1e9;
  for (int i = 1; i <= 8; ++i) {
    c.carve(round_hole(0.1, -0.2, 0.4, -0.3 * i), i);
    const double now = *c.graded().over_pulp.dentin_mm;
    EXPECT_LE(now, before) << i;
    EXPECT_GT(now, 0.0) << i;
    before = now;
  }
  c.carve(round_hole(0.1, -0.2, 0.4, -2.7), 9);
  const Result r = c.graded();
  EXPECT_EQ(*r.over_pulp.dentin_mm, 0.0);
  EXPECT_EQ(r.over_pulp.thinnest.tick, 9);
  EXPECT_TRUE(
      testing_basics::tells(r.criteria.back().reason(), Value(r.over_pulp.thinnest.site_mm)));
  EXPECT_TRUE(r.criteria.back().critical_failed);
}

TEST(OverPulp, CutsAfterTheEndDoNotCount) {
  Carved c(asking(), with_pulp(pulp_ball));
  c.carve(round_hole(0, 0, 0.4, -1.0), 2);
  c.carve(round_hole(0, 0, 0.4, -2.0), 6);
  c.events.push_back({4, Finished{Finish::ended}});
  EXPECT_EQ(c.graded().over_pulp.thinnest.tick, 2);
}

TEST(OverPulp, WithoutACutOrWithoutPulpThereIsNothingToMeasure) {
  const Carved uncut(asking(), with_pulp(pulp_ball));
  const Result r = uncut.graded();
  EXPECT_FALSE(r.over_pulp.dentin_mm);
  EXPECT_EQ(r.criteria.back().points, 0.0);
  Carved solid(asking(), dentin_block(3, 6, k_leaf_mm));
  solid.carve(round_hole(0, 0, 0.5, -1.0), 0);
  EXPECT_FALSE(solid.graded().over_pulp.dentin_mm);
}

TEST(OverPulp, ARubricThatAsksForItIsRefusedWhereTheToothHasNoPulp) {
  const Carved c(asking(), with_pulp(pulp_ball));
  EXPECT_TRUE(scenarios::not_in_this_exam(c.scenario.rubric, c.scenario, c.before).empty());
  Tooth bare = dentin_block(3, 6, 0.1);
  std::erase_if(bare.tissues, [](const Tissue& t) { return t.name == "pulp"; });
  const auto problems = scenarios::not_in_this_exam(c.scenario.rubric, c.scenario, bare);
  ASSERT_EQ(problems.size(), 1u);
}

TEST(OverPulp, ReasonMomentsAndJsonSayWhereAndWhen) {
  Carved c(asking(), with_pulp(pulp_ball));
  c.carve(box_hole(-0.5, 0.5, -0.5, 0.5, -1.0), 3);  // the whole target
  c.carve(round_hole(0, 0, 0.4, -1.8), 7);           // 0.7 mm left
  const Result r = c.graded();
  const CriterionResult& left = r.criteria.back();
  EXPECT_NEAR(left.points, 10 * (0.7 - 0.2) / (1.2 - 0.2), left.points_bound);
  EXPECT_TRUE(testing_basics::tells(left.reason(), Value(r.over_pulp.thinnest.site_mm)));
  EXPECT_EQ(left.first.tick, 7);
  const Why w = why(c.input(), r, c.scenario.rubric, "left");
  ASSERT_FALSE(w.items.empty());
  EXPECT_TRUE(std::any_of(w.items.begin(), w.items.end(), [&](const WhyItem& i) {
    return i.tick == 7 && testing_basics::tells(i.what(), Value(r.over_pulp.pulp_mm));
  }));
  const auto json = to_json(r);
  EXPECT_EQ(json["pulp"]["dentin_over_pulp_mm"], rounded(*r.over_pulp.dentin_mm));
  EXPECT_EQ(json["pulp"]["bounds"]["dentin_over_pulp_mm"], k_leaf_mm);
  EXPECT_EQ(json["pulp"]["thinnest_tick"], 7);
}

TEST(OverPulp, AResultThatWasNotAskedForItReadsAsItDidBefore) {
  Carved c(scenario_text(
               "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -0.5]\nsize_mm = [1, 1, 1]\n"),
           with_pulp(pulp_ball));
  c.carve(round_hole(0, 0, 0.5, -1.0), 3);
  EXPECT_TRUE(c.graded().over_pulp.dentin_mm);
  EXPECT_FALSE(to_json(c.graded()).contains("pulp"));
}

}  // namespace
}  // namespace cavum::grading
