// What is cut, on teeth of known geometry: of a stump, "too wide" is its walls and nothing else; a
// cavity in a side is displaced along the crown.
#include "grading/trial/faulty_preparations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grading/trial/shares_of_target.h"
#include "scenarios/zones/placed.h"
#include "tests/scenarios/test_crowns.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::grading {
namespace {

constexpr double k_round_radius_mm = 4;

/// The task with everything that its works refer to.
struct OnRoundTooth {
  scenarios::Scenario scenario;
  Tooth tooth = testing::round_tooth(k_round_radius_mm, -8, 0.1);
  scenarios::ZoneMap zones;
  Task task;
  TargetField field;
  std::vector<FaultyPreparation> works;
  explicit OnRoundTooth(const std::string& target)
      : scenario(scenarios::parse_scenario(testing::scenario_text(target), "s.toml")),
        zones(scenarios::build_zones(scenario, tooth,
                                     testing::round_landmarks(k_round_radius_mm, -6))),
        task(make_task(scenario, tooth, zones)),
        field(tooth, zones),
        works(faulty_preparations(task, field)) {}
  [[nodiscard]] const FaultyPreparation* find(const std::string& name) const {
    const auto found = std::find_if(works.begin(), works.end(),
                                    [&](const FaultyPreparation& w) { return w.name == name; });
    return found == works.end() ? nullptr : &*found;
  }
};

TEST(FaultyPreparation, OfAStumpTooWideIsItsWallsAlone) {
  const OnRoundTooth crown(
      "[[zones.target]]\nshape = \"crown\"\nabove_neck_mm = 0.5\ndepth_mm = 1.0\ntaper_deg = 0\nocclusal_mm = 1.5\n");
  const FaultyPreparation* wide = crown.find("too_wide_by_1_mm");
  ASSERT_NE(wide, nullptr);
  // the stump's wall stands at 3 mm, its top at z = -1.5, the finish line at z = -5.5
  EXPECT_LT(wide->cut({3.4, 0, -3}), 0);    // the shell itself
  EXPECT_LT(wide->cut({2.3, 0, -3}), 0);    // 0.7 mm inside the wall
  EXPECT_GT(wide->cut({1.7, 0, -3}), 0);    // 1.3 mm
  EXPECT_GT(wide->cut({0, 0, -2.0}), 0);    // below the top
  EXPECT_GT(wide->cut({3.7, 0, -6.0}), 0);  // below the finish line
  EXPECT_EQ(crown.find("opens_the_middle_65_percent"), nullptr);
  EXPECT_EQ(crown.find("shank_at_the_entrance"), nullptr);
}

TEST(FaultyPreparation, AShareOfAShallowTargetIsNoMoreThanThat) {
  // 1.0 mm deep in leaves of 0.1 mm: ten layers of equal size
  const Tooth tooth = testing::dentin_block(4, 4, 0.1);
  const auto scenario = scenarios::parse_scenario(
      testing::scenario_text(
          "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, 0]\nsize_mm = [2, 2, 2]\n"),
      "s.toml");
  const scenarios::ZoneMap zones = scenarios::build_zones(scenario, tooth);
  const TargetField field(tooth, zones);
  const auto all = static_cast<double>(field.leaves().size());
  for (const auto& [share, layers] :
       {std::pair{0.52, 5.0}, {0.68, 6.0}, {0.85, 8.0}, {0.97, 9.0}, {0.02, 0.0}, {1.0, 10.0}}) {
    const double from = beyond_which(field, share, [](Vec3 q) { return q.z; });
    const auto above = std::count_if(field.leaves().begin(), field.leaves().end(),
                                     [&](const TargetLeaf& leaf) { return leaf.at.z > from; });
    EXPECT_NEAR(static_cast<double>(above) / all, 0.1 * layers, 1e-9) << share;
  }
}

TEST(FaultyPreparation, FromASideIsShiftedTowardsOcclusalAndGingiva) {
  const OnRoundTooth cavity(
      "[[zones.target]]\nshape = \"side_cavity\"\nside = \"buccal\"\ndepth_mm = 1.2\noutline = { kind = \"polygon\", points_mm = [[-2, 1], [2, 1], "
      "[2, "
      "3], [-2, 3]] }\n");
  // the target lies between z = -5 and -3, from radius 2.8 outwards
  const FaultyPreparation *up = cavity.find("shifted_1_mm_occlusal"),
                          *down = cavity.find("shifted_1_mm_gingival");
  ASSERT_NE(up, nullptr);
  ASSERT_NE(down, nullptr);
  EXPECT_LT(up->cut({0, 3.5, -2.4}), 0);
  EXPECT_GT(up->cut({0, 3.5, -4.6}), 0);
  EXPECT_GT(down->cut({0, 3.5, -3.4}), 0);
  EXPECT_LT(down->cut({0, 3.5, -5.6}), 0);
  EXPECT_EQ(cavity.find("shifted_1_mm_buccal"), nullptr);
}

TEST(FaultyPreparation, TheContactThatIsLeftIsWhereTheNeighbourBulges) {
  // a block that ends at x = 3, and a neighbour who bulges towards it at z = -3: the target comes
  // nearest to him far above that
  const auto own = [](Vec3 p) {
    return std::max({std::fabs(p.x) - 3, std::fabs(p.y) - 3, p.z, -6 - p.z});
  };
  const auto his = [](Vec3 p) {
    return std::max(
        {3.1 + 0.4 * std::fabs(p.z + 3) - p.x, p.x - 5, std::fabs(p.y) - 3, p.z, -6 - p.z});
  };
  Tooth tooth = testing::make_tooth(
      {-3.5, -3.5, -6.5}, {5.5, 3.5, 0.5}, 0.1,
      [&](Vec3 p) -> std::uint8_t {
        if (own(p) < 0) return k_enamel;
        return his(p) < 0 ? k_neighbour_enamel : std::uint8_t{k_air};
      },
      [&](Vec3 p) { return std::min(own(p), his(p)); });
  tooth.tissues.push_back({k_neighbour_enamel, "neighbour_enamel", true});
  tooth.octree = Octree(tooth.octree.to_grid(), tooth.tissues);
  const scenarios::Scenario scenario = scenarios::parse_scenario(
      testing::scenario_text(
          "[[zones.target]]\nshape = \"box\"\nat_mm = [2, 0, -2.5]\nsize_mm = [1.8, 3, 3]\n"
          "[[zones.target]]\nshape = \"box\"\nat_mm = [2.9, 0, 0]\nsize_mm = [2, 3, 2]\n"),
      "s.toml");
  const scenarios::ZoneMap zones = scenarios::build_zones(scenario, tooth);
  const Task task = make_task(scenario, tooth, zones);
  const TargetField field(tooth, zones);
  const auto works = faulty_preparations(task, field);
  const auto left = std::find_if(works.begin(), works.end(), [](const FaultyPreparation& w) {
    return w.name == "leaves_the_contact";
  });
  ASSERT_NE(left, works.end());
  EXPECT_LT(left->cut({2.0, 0, -3}), 0) << "the target";
  EXPECT_GT(left->cut({2.6, 0, -3}), 0) << "0.8 mm before the bulge";
  EXPECT_GT(left->cut({2.6, 0, -0.3}), 0) << "the wall stands upright to its top";
}

}  // namespace
}  // namespace cavum::grading
