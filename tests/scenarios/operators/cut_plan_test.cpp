#include "scenarios/operators/cut_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/base/file.h"
#include "scenarios/file/parse.h"
#include "scenarios/operators/operator.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

using testing::dentin_block;
using testing::scenario_text;

const char k_upright[] =
    "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -0.5]\nsize_mm = [3, 2, 3]\n";
const char k_leaning[] =
    "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -0.5]\nsize_mm = [3, 2, 3]\naxis = [0, -0.5, 0.8660254]\n";

ContactTool cylinder() {
  const std::string path = std::string(CAVUM_SOURCE_DIR) + "/data/burs/cylinder-flat-1.0.toml";
  return make_contact_tool(parse_bur(read_text_file(path), path));
}

struct Planned {
  Tooth tooth = dentin_block(4, 4, 0.05);
  ContactTool tool = cylinder();
  Scenario scenario;
  ZoneMap zones;
  explicit Planned(const std::string& text)
      : scenario(parse_scenario(text, "s.toml")), zones(build_zones(scenario, tooth)) {}
  [[nodiscard]] ReachMap reach(const MarginSpec& margin) const {
    return reach_map(zones, tooth, tool, margin);
  }
  /// How far beyond the target's surface the head comes at the waypoints, where there is tissue;
  /// none where it stays inside.
  [[nodiscard]] double furthest_mm(const std::vector<Waypoint>& way, const Mat3& held,
                                   bool bottom) const {
    double furthest = -1e9;
    for (const auto& w : way) {
      if (!w.cut) continue;
      for (double h = 0; h <= tool.bur.cutting_length_mm; h += 0.1)
        for (const Vec3 side : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}}) {
          const Vec3 p =
              w.tip_mm + held * (side * (0.99 * tool.bur.profile.radius_mm(h)) + Vec3{0, 0, h});
          const IVec3 leaf = tooth.octree.leaf_at(p);
          if (tooth.octree.tissue(leaf) == k_air || (zones.wall(leaf) == Wall::floor) != bottom)
            continue;
          furthest = std::max(furthest, zones.distance_mm(p));
        }
    }
    return furthest;
  }
};

// Whatever the width, no place of a layer is further from the bur's ways than the head is wide: a
// pillar would be left.
TEST(CutPlan, LeavesNoCoreBetweenItsLoops) {
  for (double width = 1.6; width < 4.4; width += 0.1) {
    const std::string box = "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -0.5]\nsize_mm = [" +
                            std::to_string(width) + ", " + std::to_string(width - 0.2) + ", 3]\n";
    const Planned p(scenario_text(box));
    const ReachMap map = p.reach(k_expert_margin);
    PlanOptions options;
    options.finish_spacing_mm = 1e9;
    const auto way = plan_cut(map, p.tooth, options);
    double furthest = 0;
    for (int y = 0; y < map.ny; ++y)
      for (int x = 0; x < map.nx; ++x) {
        const double low = map.lowest_mm[map.index(x, y)];
        if (low == ReachMap::k_unreachable) continue;
        const Vec3 column = map.at(x, y, low);
        double nearest = 1e9;
        for (std::size_t i = 1; i < way.size(); ++i) {
          if (!way[i].cut || !way[i - 1].cut) continue;
          const Vec3 a = way[i - 1].tip_mm, ab = way[i].tip_mm - a, ac = column - a;
          const double n = ab.x * ab.x + ab.y * ab.y,
                       t = n > 0 ? std::clamp((ac.x * ab.x + ac.y * ab.y) / n, 0.0, 1.0) : 0.0;
          nearest = std::min(nearest, std::hypot(ac.x - t * ab.x, ac.y - t * ab.y));
        }
        furthest = std::max(furthest, nearest);
      }
    EXPECT_LT(furthest, 0.45) << "target " << width << " mm wide, head of 0.5 mm radius";
  }
}

TEST(CutPlan, FollowsALeaningTargetAlongItsAxisAndStaysInIt) {
  const Planned p(scenario_text(k_leaning));
  const ReachMap map = p.reach(k_expert_margin);
  EXPECT_NEAR(length(map.tool * Vec3{0, 0, 1} - Vec3{0, -0.5, 0.8660254}), 0, 1e-6);
  const auto way = plan_cut(map, p.tooth, PlanOptions{});
  ASSERT_GT(way.size(), 20u);
  EXPECT_LT(p.furthest_mm(way, map.tool, false), 0.1);
  EXPECT_LT(p.furthest_mm(way, map.tool, true), 0.15);
  EXPECT_GT(coverage(free_room(p.zones, p.tooth, k_expert_margin), map, p.tool), 0.9)
      << "upright, the bur could not get below the overhanging wall";
}

/// The chambered block's roof is flat at z = -3 between its horns, which are no wider than the
/// head.
TEST(CutPlan, ThePilotHoleGoesThroughTheFlatOfTheRoofAndNotIntoAHorn) {
  const Tooth tooth = testing::chambered_block(0.1);
  const Scenario scenario = parse_scenario(
      scenario_text("[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -2]\nsize_mm = [3, 2, 5]\n"),
      "s.toml");
  const ZoneMap zones = build_zones(scenario, tooth);
  const ContactTool tool = cylinder();
  const ReachMap map = reach_map(zones, tooth, tool, k_expert_margin);
  const auto way = plan_pilot(map, tooth, tool.bur.head_radius_mm, {"pulp"});
  ASSERT_EQ(way.size(), 4u);
  const Vec3 p = way[2].tip_mm;  // the horns: |x| from 0.9 to 1.4, |y| up to 0.3
  EXPECT_GT(std::hypot(std::max(0.0, 0.9 - std::abs(p.x)), std::max(0.0, std::abs(p.y) - 0.3)),
            0.25);
  EXPECT_NEAR(p.z, -3.35, 0.11);
  EXPECT_TRUE(way[2].careful);
  EXPECT_GT(way.front().tip_mm.z, 0);
  EXPECT_GT(way.back().tip_mm.z, 0);
  for (const auto& w : way)
    EXPECT_NEAR(std::hypot(w.tip_mm.x - way[0].tip_mm.x, w.tip_mm.y - way[0].tip_mm.y), 0, 1e-9);
  EXPECT_TRUE(plan_pilot(map, tooth, tool.bur.head_radius_mm, {}).empty());
}

TEST(CutPlan, WithAWiderMarginGoesThatFarBeyondTheSidesOrTheFloorAndNotTheOther) {
  const Planned p(scenario_text(k_upright));
  const ReachMap wide = p.reach({0.6, 0.03}), deep = p.reach({0.03, 0.6});
  EXPECT_NEAR(p.furthest_mm(plan_cut(wide, p.tooth, PlanOptions{}), wide.tool, false), 0.6, 0.11);
  EXPECT_LT(p.furthest_mm(plan_cut(wide, p.tooth, PlanOptions{}), wide.tool, true), 0.15);
  EXPECT_NEAR(p.furthest_mm(plan_cut(deep, p.tooth, PlanOptions{}), deep.tool, true), 0.6, 0.11);
  EXPECT_LT(p.furthest_mm(plan_cut(deep, p.tooth, PlanOptions{}), deep.tool, false), 0.1);
}

TEST(CutPlan, LeavesOutPlacesThatStandHighAndRemoveNothingOfTheirOwn) {
  // columns of 0.25 mm in a row, the target three millimetres deep under all of them but the last
  FreeRoom room;
  room.map.nx = 12, room.map.ny = 1, room.map.step_mm = 0.25, room.map.bottom_mm = 0,
  room.map.top_mm = 3;
  room.step_mm = 0.1;
  room.target.assign(12 * 30, 1);
  ReachMap map = room.map;
  map.lowest_mm = {0,
                   0,
                   0,
                   0,
                   0,
                   2.0,
                   0.9,
                   ReachMap::k_unreachable,
                   ReachMap::k_unreachable,
                   ReachMap::k_unreachable,
                   ReachMap::k_unreachable,
                   2.5};
  const ContactTool tool = cylinder();  // reaches two columns to either side
  for (std::size_t k = 0; k < 30; ++k)
    for (const std::size_t c : {7, 8}) room.target[12 * k + c] = 0;
  const ReachMap kept = without_skimming(room, map, tool);
  for (std::size_t c = 0; c < 5; ++c) EXPECT_EQ(kept.lowest_mm[c], 0) << c;
  EXPECT_EQ(kept.lowest_mm[5], ReachMap::k_unreachable)
      << "what it reaches the fourth and the sixth do, deeper by a millimetre and more";
  EXPECT_EQ(kept.lowest_mm[6], 0.9) << "less than a millimetre higher";
  EXPECT_EQ(kept.lowest_mm[11], 2.5) << "high, but nothing else reaches what lies there";
}

TEST(CutPlan, ForTheMiddleKeepsThatShareOfLengthAndWidth) {
  const Planned p(scenario_text(k_upright));
  const ReachMap all = p.reach(k_expert_margin), half = middle_of(all, 50);
  const auto extent = [](const ReachMap& m) {
    int low_x = m.nx, high_x = -1, low_y = m.ny, high_y = -1;
    for (int y = 0; y < m.ny; ++y)
      for (int x = 0; x < m.nx; ++x)
        if (m.lowest_mm[m.index(x, y)] < ReachMap::k_unreachable) {
          low_x = std::min(low_x, x);
          high_x = std::max(high_x, x);
          low_y = std::min(low_y, y);
          high_y = std::max(high_y, y);
        }
    return std::pair((high_x - low_x + 1) * m.step_mm, (high_y - low_y + 1) * m.step_mm);
  };
  EXPECT_NEAR(extent(half).first, 0.5 * extent(all).first, 2 * all.step_mm);
  EXPECT_NEAR(extent(half).second, 0.5 * extent(all).second, 2 * all.step_mm);
}

TEST(CarelessCandidate, IsRefusedByAScenarioThatDoesNotNameTheMistake) {
  const Planned p(scenario_text(k_upright));
  EXPECT_THROW(
      static_cast<void>(make_candidate("careless", p.scenario, p.zones, p.tooth, {p.tool}, 1)),
      Error);
  const Planned q(scenario_text(k_upright, "[careless]\nsides_mm = 0.5\nfails_by = \"sides\"\n"));
  EXPECT_NO_THROW(
      static_cast<void>(make_candidate("careless", q.scenario, q.zones, q.tooth, {q.tool}, 1)));
}

}  // namespace
}  // namespace cavum::scenarios
