// What was done beside the tooth, against closed forms: balls and blocks for teeth.
#include "grading/measures/adjacent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "engine/tooth/make/add_adjacent.h"
#include "engine/tooth/octree_edit.h"
#include "grading/marking/grade.h"
#include "grading/result/result_json.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/carved_adjacent.h"

namespace cavum::grading {
namespace {

using testing::Carved;
using testing::CarvedAdjacent;
using testing::make_tooth;
using testing::scenario_text;

constexpr double k_beside_leaf_mm = 0.1, k_radius_mm = 3.0, k_pi_mm = std::numbers::pi;

Tooth ball() {
  const auto field = [](Vec3 p) { return length(p) - k_radius_mm; };
  return make_tooth(
      {-3.3, -3.3, -3.3}, {3.3, 3.3, 3.3}, k_beside_leaf_mm,
      [&](Vec3 p) { return field(p) < 0 ? k_enamel : k_air; }, field);
}
Tooth block() {
  const auto field = [](Vec3 p) {
    return std::max({std::fabs(p.x) - 2.0, std::fabs(p.y) - 2.0, p.z, -3.0 - p.z});
  };
  return make_tooth(
      {-2.4, -2.4, -3.4}, {2.4, 2.4, 0.4}, k_beside_leaf_mm,
      [&](Vec3 p) { return field(p) < 0 ? k_enamel : k_air; }, field);
}
Tooth beside_itself(const Tooth& tooth, double contact_mm) {
  AdjacentSpec spec;
  spec.mesial.tooth = &tooth;
  spec.contact_mm = contact_mm;
  return add_adjacent(tooth, spec, "here").tooth;
}

/// A box at the contact: half a millimetre wide to each side, its floor so far below the contact.
std::string box_at_contact(double below_mm, double half_mm = 0.8) {
  return scenario_text(
      fmt::format("[[zones.target]]\nshape = \"box\"\nat_mm = [{}, 0, {}]\nsize_mm = [2, {}, 6]\n",
                  k_radius_mm - 0.3, 3.0 - below_mm, 2 * half_mm),
      "[[rubric.criteria]]\nid = \"clear\"\nmetric = \"proximal_clearance_mm\"\nfull = 0.3\nzero = 0.05\npoints = 10\n"
      "[[rubric.criteria]]\nid = \"nick\"\nmetric = \"neighbour_nick_depth_mm\"\nfull = 0\nzero = 0.3\npoints = 10\ncritical_above = 0.3\n");
}

TEST(AdjacentMeasures, ABallOutOfABallIsAsDeepAndWideAsTheirLens) {
  for (const double radius : {0.5, 0.8}) {
    CarvedAdjacent c(box_at_contact(0.8), beside_itself(ball(), 0.05));
    const Vec3 pole{k_radius_mm + 0.05, 0, 0};
    c.carve([&](Vec3 p) { return length(p - pole) - radius; }, 5, {0, -2, -2}, {5, 2, 2});
    const AdjacentMeasures m = c.graded().beside;
    ASSERT_TRUE(m.neighbours);
    EXPECT_NEAR(m.nick_depth_mm, radius, m.nick_depth_bound_mm) << radius;
    EXPECT_NEAR(m.deepest.site_mm.x, pole.x + radius, 2 * k_beside_leaf_mm);
    EXPECT_EQ(m.deepest.tick, 5);
    // the cap of a sphere within r of a place on it has the area pi r²; the lens is that of two
    // balls whose surfaces meet in the one's middle
    EXPECT_NEAR(m.nick_area_mm2, k_pi_mm * radius * radius, m.nick_area_bound_mm2) << radius;
    const double lens =
        k_pi_mm * radius * radius * radius * (2.0 / 3.0 - radius / (4.0 * k_radius_mm));
    EXPECT_NEAR(m.neighbour_removed.mm3, lens, m.neighbour_removed.bound_mm3) << radius;
    EXPECT_LT(m.nick_area_bound_mm2, 0.4 * m.nick_area_mm2);
  }
}

TEST(AdjacentMeasures, OfTheToothItselfTheNickIsNoOvercutAndNothingOutside) {
  const std::string text = box_at_contact(0.8);
  CarvedAdjacent with(text, beside_itself(ball(), 0.05));
  Carved alone(text, ball());
  const auto target = [](Vec3 p) {
    return std::max({std::fabs(p.x - 2.7) - 1.0, std::fabs(p.y) - 0.8, -0.8 - p.z});
  };
  with.carve(target, 3, {1, -2, -2}, {5, 2, 5});
  alone.carve(target, 3, {1, -2, -2}, {5, 2, 5});
  const Result a = with.graded(), b = alone.graded();
  EXPECT_GT(a.beside.nick_depth_mm, 0.5);
  EXPECT_NEAR(a.volumes.removed.mm3, b.volumes.removed.mm3, 0.02);
  EXPECT_NEAR(a.volumes.outside().mm3, b.volumes.outside().mm3, 0.01);
  EXPECT_NEAR(a.shape.wall[1].max_over_mm, b.shape.wall[1].max_over_mm, k_beside_leaf_mm);
  EXPECT_EQ(a.notes.size(), b.notes.size());
  EXPECT_FALSE(to_json(b).contains("beside"));
  EXPECT_EQ(to_json(a)["beside"]["neighbour_nick_depth_mm"], rounded(a.beside.nick_depth_mm));
  EXPECT_TRUE(testing_basics::tells(a.criteria.back().reason(), Value(a.beside.deepest.site_mm)));
  EXPECT_TRUE(a.criteria.back().critical_failed);
}

TEST(AdjacentMeasures, ClearanceOfBallsIsThatOfTheFloorsMargin) {
  for (const double below : {0.8, 1.4}) {
    CarvedAdjacent c(box_at_contact(below, 1.6), beside_itself(ball(), 0.0));
    EXPECT_NEAR(*c.graded().beside.clearance_mm, 0.0, k_beside_leaf_mm) << "untouched";
    const double gap = 0.02;  // stays off the neighbour
    c.carve(
        [&](Vec3 p) {
          return std::max(
              {1.7 - p.x, std::fabs(p.y) - 1.6, -below - p.z, length(p) - k_radius_mm - gap});
        },
        0, {1, -3, -3}, {5, 3, 5});
    const AdjacentMeasures m = c.graded().beside;
    const Vec3 margin{std::sqrt(k_radius_mm * k_radius_mm - below * below), 0, -below};
    ASSERT_TRUE(m.clearance_mm) << below;
    EXPECT_NEAR(*m.clearance_mm, length(margin - Vec3{2 * k_radius_mm, 0, 0}) - k_radius_mm,
                m.clearance_bound_mm)
        << below;
    EXPECT_DOUBLE_EQ(m.clearance_bound_mm, k_beside_leaf_mm);
    EXPECT_NEAR(m.clearance_from_mm.z, -below, 3 * k_beside_leaf_mm);
  }
}

TEST(AdjacentMeasures, ClearanceOfBlocksIsTheirDistance) {
  for (const double gap : {0.02, 0.06}) {
    CarvedAdjacent c(
        scenario_text(
            "[[zones.target]]\nshape = \"box\"\nat_mm = [2, 0, 0]\nsize_mm = [2, 2, 3]\n",
            "[[rubric.criteria]]\nid = \"clear\"\nmetric = \"proximal_clearance_mm\"\nfull = 0.3\nzero = 0.05\npoints = 10\n"),
        beside_itself(block(), gap));
    c.carve(
        [](Vec3 p) {
          return std::max({1.0 - p.x, p.x - 2.0, std::fabs(p.y) - 1.0, -1.5 - p.z});
        },
        0, {0, -2, -3}, {4, 2, 2});
    EXPECT_NEAR(*c.graded().beside.clearance_mm, gap, 0.5 * k_beside_leaf_mm) << gap;
  }
}

TEST(AdjacentMeasures, AThinShellIsTakenAsBrokenOutAndAThickOneStands) {
  for (const auto& [shell, opened] : {std::pair(0.4, true), std::pair(0.8, false)}) {
    CarvedAdjacent c(box_at_contact(1.2, 1.6), beside_itself(ball(), 0.0));
    c.carve(
        [shell = shell](Vec3 p) {
          return std::max(
              {1.7 - p.x, std::fabs(p.y) - 1.6, -1.2 - p.z, length(p) - k_radius_mm + shell});
        },
        0, {1, -3, -3}, {5, 3, 5});
    const AdjacentMeasures m = c.graded().beside;
    ASSERT_TRUE(m.clearance_mm);
    if (opened)
      EXPECT_GT(*m.clearance_mm, 0.2) << shell;
    else
      EXPECT_LT(*m.clearance_mm, 0.05) << shell;
    EXPECT_EQ(m.nick_depth_mm, 0.0);
  }
}

TEST(AdjacentMeasures, WhereTheTargetOpensNoContactThereIsNoClearance) {
  CarvedAdjacent c(
      scenario_text("[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, 3]\nsize_mm = [1, 1, 2]\n"),
      beside_itself(ball(), 0.0));
  EXPECT_FALSE(c.graded().beside.clearance_mm);
}

TEST(AdjacentMeasures, GumCountsByItsVolumeAndByTheTenthsInWhichItIsCut) {
  Tooth tooth = ball();
  tooth.tissues.push_back({k_gingiva, "gingiva", true});
  TissueGrid grid = tooth.octree.to_grid();
  // a slab of gum below a ball, 0.4 mm thick
  for (int z = 0; z < 4; ++z)
    for (int y = 5; y < 55; ++y)
      for (int x = 5; x < 55; ++x)
        if (const std::size_t i = grid.index({x, y, z}); grid.tissue[i] == k_air)
          grid.tissue[i] = k_gingiva;
  grid.make_consistent(tooth.tissues);
  tooth.octree = Octree(grid, tooth.tissues);
  CarvedAdjacent c(box_at_contact(0.8), tooth);
  const double floor = grid.origin_mm.z;
  const auto hole = [&](double x) {
    return [=](Vec3 p) {
      return std::max(std::sqrt((p.x - x) * (p.x - x) + (p.y + 1.5) * (p.y + 1.5)) - 0.3,
                      p.z - floor - 0.25);
    };
  };
  c.carve(hole(-1.5), 250, {-3, -3, -4}, {3, 3, -2});
  c.carve(hole(0.0), 320, {-3, -3, -4}, {3, 3, -2});
  c.carve(hole(1.5), 910, {-3, -3, -4}, {3, 3, -2});
  const Result r = c.graded();
  ASSERT_TRUE(r.beside.gum);
  EXPECT_FALSE(r.beside.neighbours);
  EXPECT_NEAR(r.beside.gum_removed.mm3, 3 * k_pi_mm * 0.09 * 0.25, r.beside.gum_removed.bound_mm3);
  EXPECT_NEAR(r.beside.gum_touched_s, 0.3, 1e-9);
  EXPECT_NEAR(r.beside.gum_touched_bound_s, 0.2, 1e-9);  // two stretches
  EXPECT_EQ(r.beside.first_gum.tick, 250);
  EXPECT_EQ(r.volumes.removed.mm3, 0.0);
}

}  // namespace
}  // namespace cavum::grading
