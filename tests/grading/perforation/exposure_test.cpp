#include "grading/perforation/exposure.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

using testing::box_hole;
using testing::Carved;
using testing::chambered_block;
using testing::make_tooth;
using testing::round_hole;
using testing::scenario_text;

const char k_target[] =
    "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, 0]\nsize_mm = [1, 1, 1]\n";
constexpr double k_leaf_mm = 0.05;

PerforationTruth truth_of(const Carved& c) { return c.graded().perforation.fault; }

TEST(Exposure, AFloorAHairBeyondTheRoofIsAHoleAsWideAsTheFloor) {
  Carved c(scenario_text(k_target), chambered_block(k_leaf_mm));
  c.carve(round_hole(0, 0, 0.5, -3.01), 7);  // the roof lies at -3 between the horns
  const PerforationTruth t = truth_of(c);
  EXPECT_TRUE(t.perforated);
  EXPECT_EQ(t.tissue, "pulp");
  EXPECT_EQ(t.first.tick, 7);
  EXPECT_EQ(t.volume_mm3, 0.0);
  EXPECT_NEAR(t.area_mm2, std::numbers::pi * 0.25, t.area_bound_mm2);
  EXPECT_NEAR(t.area_bound_mm2, 0.5 * k_leaf_mm * std::numbers::pi,
              0.3 * k_leaf_mm * std::numbers::pi)
      << "half a leaf along the rim";
}

TEST(Exposure, DentinThatIsLeftOverThePulpIsNoHole) {
  Carved c(scenario_text(k_target), chambered_block(k_leaf_mm));
  c.carve(round_hole(0, 0, 0.5, -2.94), 7);
  EXPECT_FALSE(truth_of(c).perforated);
  EXPECT_EQ(truth_of(c).area_mm2, 0.0);
}

TEST(Exposure, AWallOpenedFromTheSideCountsByItsArea) {
  Carved c(scenario_text(k_target), chambered_block(k_leaf_mm));
  c.carve(box_hole(1.5, 2.5, -0.8, 0.8, -4.2),
          3);  // beside the chamber's wall at x = 1.5, 1.6 x 1.2 mm of it
  const PerforationTruth t = truth_of(c);
  EXPECT_NEAR(t.area_mm2, 1.6 * 1.2, t.area_bound_mm2);
  EXPECT_EQ(t.volume_mm3, 0.0);
}

/// A ball of pulp, 1 mm in radius, its middle 3 mm below the top of a block.
Tooth with_ball() {
  const auto from_ball = [](Vec3 p) { return length(p - Vec3{0, 0, -3}) - 1.0; };
  return make_tooth(
      {-3, -3, -6}, {3, 3, 0.5}, k_leaf_mm,
      [=](Vec3 p) -> std::uint8_t {
        return p.z > 0 ? k_air : from_ball(p) < 0 ? k_pulp : k_dentin;
      },
      [=](Vec3 p) { return std::max(p.z, -from_ball(p)); });
}

TEST(Exposure, OfARoundHornIsTheAreaOfTheCapAndNotOfItsStairs) {
  for (const double open : {0.2, 0.5, 1.0}) {
    Carved c(scenario_text(k_target), with_ball());
    // all dentin down to a level is gone, and the pulp stays: a cap of the ball lies open
    c.carve(
        [&](Vec3 p) {
          return std::max(-2.0 - open - p.z, 1.0 + 1e-9 - length(p - Vec3{0, 0, -3}));
        },
        0);
    const PerforationTruth t = truth_of(c);
    const double cap = 2.0 * std::numbers::pi * open;
    EXPECT_NEAR(t.area_mm2, cap, t.area_bound_mm2 + 0.03 * cap) << open;
  }
}

TEST(Exposure, PulpThatIsTakenIsCountedBesideTheHole) {
  Carved c(scenario_text(k_target), chambered_block(k_leaf_mm));
  c.carve(round_hole(0, 0, 0.5, -2.9), 1);
  c.carve(round_hole(0, 0, 0.5, -3.4), 5);
  const PerforationTruth t = truth_of(c);
  EXPECT_EQ(t.first.tick, 5);
  EXPECT_NEAR(t.area_mm2, std::numbers::pi * 0.25, t.area_bound_mm2);
  EXPECT_NEAR(t.volume_mm3, std::numbers::pi * 0.25 * 0.4, 0.01);
}

TEST(Exposure, PulpThatReachesTheSidesOfABlockIsOpenedFromTheTopHoweverThinItsRoof) {
  const Tooth block = make_tooth(
      {-3, -3, -4}, {3, 3, 0.5}, k_leaf_mm,
      [](Vec3 p) -> std::uint8_t {
        return p.z > 0      ? k_air
               : p.z > -0.2 ? k_enamel
               : p.z > -0.5 ? k_dentin
               : p.z > -2.0 ? k_pulp
                            : k_dentin;
      },
      [](Vec3 p) { return std::max(p.z, std::min(-0.5 - p.z, p.z + 2.0)); });
  Carved c(scenario_text(k_target), block);
  for (int tick = 0; tick < 15; ++tick)
    c.carve(round_hole(0, 0, 0.5, -0.05 * tick), tick);  // to 0.7 mm
  const PerforationTruth t = truth_of(c);
  EXPECT_TRUE(t.perforated);
  EXPECT_NEAR(t.area_mm2, std::numbers::pi * 0.25, t.area_bound_mm2);
  EXPECT_EQ(t.outside_mm3, 0.0);
}

/// A root: a post of dentin, 2 mm in radius, in a sheath of periodontium 0.3 mm thick below z = -1;
/// air around and above.
Tooth root() {
  const auto across = [](Vec3 p) { return std::sqrt(p.x * p.x + p.y * p.y); };
  return make_tooth(
      {-4, -4, -6}, {4, 4, 0.5}, k_leaf_mm,
      [=](Vec3 p) -> std::uint8_t {
        return p.z < 0 && across(p) < 2      ? k_dentin
               : p.z < -1 && across(p) < 2.3 ? k_periodontium
                                             : k_air;
      },
      [=](Vec3 p) { return std::max(p.z, across(p) - 2.0); });
}

/// A round tool that stands upright at x, and comes down beside or into the root.
auto upright(double x, double radius, double to_z) { return round_hole(x, 0, radius, to_z); }

TEST(Exposure, PeriodontiumSweptBesideTheRootIsNoPerforation) {
  Carved c(scenario_text(k_target), root());
  for (int tick = 0; tick < 40; ++tick)
    c.carve(upright(2.55, 0.5, -0.1 * tick), tick);  // to 2.05 mm from the axis
  const PerforationTruth t = truth_of(c);
  EXPECT_FALSE(t.perforated);
  EXPECT_EQ(t.area_mm2, 0.0);
  EXPECT_GT(t.outside_mm3, 0.3);
  EXPECT_EQ(t.volume_mm3, 0.0);
}

TEST(Exposure, AScrapeAlongTheRootFromOutsideIsNoPerforation) {
  for (const double deep : {0.05, 0.15, 0.25}) {
    Carved c(scenario_text(k_target), root());
    for (int tick = 0; tick < 40; ++tick) c.carve(upright(2.5 - deep, 0.5, -0.1 * tick), tick);
    const PerforationTruth t = truth_of(c);
    EXPECT_FALSE(t.perforated) << deep << " mm deep, " << t.area_mm2 << " mm2";
    EXPECT_GT(t.outside_mm3, 0.3);
  }
}

TEST(Exposure, ARootPerforatedFromInsideIs) {
  Carved c(scenario_text(k_target), root());
  for (int tick = 0; tick < 40; ++tick) c.carve(upright(1.0, 0.5, -0.1 * tick), tick);
  EXPECT_FALSE(truth_of(c).perforated);
  // from the canal sideways, at z = -3: a ball of 0.4 mm radius goes out through the wall
  for (int tick = 40; tick < 70; ++tick)
    c.carve([&](Vec3 p) { return length(p - Vec3{1.0 + 0.025 * (tick - 40), 0, -3}) - 0.4; }, tick);
  const PerforationTruth t = truth_of(c);
  EXPECT_TRUE(t.perforated);
  EXPECT_EQ(t.tissue, "periodontium");
  EXPECT_EQ(t.outside_mm3, 0.0);
  EXPECT_GT(t.area_mm2, 0.0);
  // the ball's front is at 1.4 + 0.025 (tick - 40) mm: it comes to the root's surface in tick 64
  EXPECT_NEAR(static_cast<double>(t.first.tick), 64.0, 2.0);
}

TEST(Exposure, OfAnAimAndOfAFaultAreTwoThings) {
  Carved c(testing::opening_pulp(testing::k_chamber_target), chambered_block(k_leaf_mm));
  c.carve(box_hole(-1.5, 1.5, -1, 1, -4.5), 100);
  const Result r = c.graded();
  EXPECT_TRUE(r.perforation.aim.perforated);
  EXPECT_FALSE(r.perforation.fault.perforated);
  EXPECT_NEAR(r.perforation.aim.volume_mm3, 3.0 * 2.0 * 1.5 + 2 * 0.5 * 0.6 * 0.5, 0.05);
}

}  // namespace
}  // namespace cavum::grading
