// Pictures of sections: how much of the tooth they show.
#include "scenarios/picture.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "tests/scenarios/test_teeth.h"

namespace cavum {
namespace {

constexpr double k_scale = 20;  // px per mm

double height_px(const std::string& svg) {
  const auto at = svg.find("height='");
  return at == std::string::npos ? -1 : std::strtod(svg.c_str() + at + 8, nullptr);
}

TEST(Picture, AChannelDrilledFarBelowTheTargetIsShownToItsEnd) {
  const Tooth block = testing::dentin_block(3, 9, 0.1);
  const Scenario s =
      parse_scenario(testing::scenario_text("[[zones.target]]\nshape = \"cylinder\"\nat_mm = [0, 0, -1]\nradius_mm = 1\nheight_mm = 2\n"), "s.toml");
  const ZoneMap zones = build_zones(s, block);
  const auto drawn = [&](double deepest_mm, View view) {
    Octree after = block.octree;
    after.reserve_edits(60000);
    std::vector<RemovedLeaf> removed;
    removed.reserve(100000);
    EXPECT_TRUE(after.carve(
        {-1, -1, -9}, {1, 1, 1},
        [&](Vec3 p) {
          return std::max({std::fabs(p.x) - 0.3, std::fabs(p.y) - 0.3, deepest_mm - p.z});
        },
        removed));
    return height_px(section_svg(block, &after, zones, {view, 0.01, k_scale, "", false, nullptr}));
  };
  for (const View view : {View::mesio_distal, View::bucco_lingual}) {
    const double usual = drawn(-1, view);
    EXPECT_DOUBLE_EQ(drawn(-3, view), usual) << "4 mm below the target are shown anyway";
    EXPECT_NEAR(drawn(-7, view) - usual, (7.0 + 0.6 - 5.0) * k_scale, 0.11 * k_scale);
    EXPECT_NEAR(drawn(-8.8, view) - usual, (9.0 - 5.0) * k_scale, 0.11 * k_scale) << "to the tooth's end";
  }
}

TEST(Picture, TheCrownIsShownToItsTipAlsoFarAboveTheTarget) {
  const Tooth block = testing::dentin_block(3, 6, 0.1);  // its top at z = 0
  const auto drawn = [&](const char* at) {
    const Scenario s = parse_scenario(
        testing::scenario_text("[[zones.target]]\nshape = \"box\"\nat_mm = [3, 0, " + std::string(at) + "]\nsize_mm = [2, 1, 1]\n"), "s.toml");
    return height_px(section_svg(block, nullptr, build_zones(s, block), {View::mesio_distal, 0.01, k_scale, "", false, nullptr}));
  };
  // the target lies in the block's side, its own top 0.5 or 1 mm below the block's; 4 mm below it are shown, and a little air above the block
  EXPECT_NEAR(drawn("-1.5") - drawn("-1"), 0.5 * k_scale, 0.11 * k_scale);
}

}  // namespace
}  // namespace cavum
