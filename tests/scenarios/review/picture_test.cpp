// Pictures of sections: how much of the tooth they show.
#include "scenarios/review/picture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/file.h"
#include "engine/tooth/octree_edit.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

constexpr double k_scale = 20;  // px per mm

double height_px(const std::string& svg) {
  const auto at = svg.find("height='");
  return at == std::string::npos ? -1 : std::strtod(svg.c_str() + at + 8, nullptr);
}

TEST(Picture, AChannelDrilledFarBelowTheTargetIsShownToItsEnd) {
  const Tooth block = testing::dentin_block(3, 9, 0.1);
  const Scenario s = parse_scenario(
      testing::scenario_text(
          "[[zones.target]]\nshape = \"cylinder\"\nat_mm = [0, 0, -1]\nradius_mm = 1\nheight_mm = 2\n"),
      "s.toml");
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
    EXPECT_NEAR(drawn(-8.8, view) - usual, (9.0 - 5.0) * k_scale, 0.11 * k_scale)
        << "to the tooth's end";
  }
}

TEST(Picture, TheCrownIsShownToItsTipAlsoFarAboveTheTarget) {
  const Tooth block = testing::dentin_block(3, 6, 0.1);  // its top at z = 0
  const auto drawn = [&](const char* at) {
    const Scenario s =
        parse_scenario(testing::scenario_text("[[zones.target]]\nshape = \"box\"\nat_mm = [3, 0, " +
                                              std::string(at) + "]\nsize_mm = [2, 1, 1]\n"),
                       "s.toml");
    return height_px(section_svg(block, nullptr, build_zones(s, block),
                                 {View::mesio_distal, 0.01, k_scale, "", false, nullptr}));
  };
  // the target lies in the block's side, its own top 0.5 or 1 mm below the block's; 4 mm below it
  // are shown, and a little air above the block
  EXPECT_NEAR(drawn("-1.5") - drawn("-1"), 0.5 * k_scale, 0.11 * k_scale);
}

/// Leaves that a section draws in a colour: its runs added up.
std::size_t drawn_in(const std::string& svg, const std::string& colour) {
  const auto at = svg.find("fill='" + colour + "' d='");
  if (at == std::string::npos) return 0;
  const auto end = svg.find("'/>", at);
  std::size_t leaves = 0;
  for (auto run = svg.find('h', svg.find("d='", at)); run < end; run = svg.find('h', run + 1))
    if (svg[run + 1] != '-') leaves += std::strtoul(svg.c_str() + run + 1, nullptr, 10);
  return leaves;
}

/// The steps and colours of the class's tooth in 3D, from its page's source: {from, {over, under}},
/// the highest first.
std::vector<std::pair<double, std::pair<std::string, std::string>>> bands_of_the_page() {
  const std::string source = read_text_file(CAVUM_SOURCE_DIR "/ui/report/page/src/deviation.ts");
  const auto list = [&](const std::string& name) {
    const auto at = source.find("export const " + name + " = [");
    if (at == std::string::npos) throw std::runtime_error("deviation.ts has no " + name);
    const auto begin = source.find('[', at) + 1;
    return nlohmann::json::parse("[" + source.substr(begin, source.find(']', begin) - begin) + "]");
  };
  const auto edges = list("k_heat_edges"), over = list("k_over"), under = list("k_under");
  std::vector<std::pair<double, std::pair<std::string, std::string>>> bands;
  for (std::size_t i = edges.size(); i-- > 0;)
    bands.push_back({100.0 * edges[i].get<double>(),
                     {over.at(i).get<std::string>(), under.at(i).get<std::string>()}});
  return bands;
}

TEST(Picture, HowManyCutWronglyIsDrawnLeafByLeafInItsBand) {
  const Tooth block = testing::dentin_block(3, 5, 0.1);
  const Scenario s = parse_scenario(
      testing::scenario_text(
          "[[zones.target]]\nshape = \"cylinder\"\nat_mm = [0, 0, -1]\nradius_mm = 1\nheight_mm = 2\n"),
      "s.toml");
  const ZoneMap zones = build_zones(s, block);
  const Octree& tree = block.octree;
  const int low_z = tree.leaf_at({0.01, 0.01, -4.9}).z;
  // ever more of the class from one side to the other, on both sides of none
  const auto heat = [&](IVec3 leaf) { return -95.0 + 190.0 * leaf.x / (tree.size().x - 1); };
  PictureSpec spec{View::mesio_distal, 0.01, k_scale, ""};
  spec.heat_percent = heat;
  const std::string svg = section_svg(block, nullptr, zones, spec);
  const auto bands = bands_of_the_page();
  std::map<std::string, std::size_t> expected;
  const int y = tree.leaf_at({0.01, 0.01, 0.01}).y;
  for (int z = low_z; z < tree.size().z; ++z)
    for (int x = 0; x < tree.size().x; ++x) {
      if (tree.tissue({x, y, z}) == k_air) continue;
      const double h = heat({x, y, z});
      for (const auto& [from, colours] : bands)
        if (std::fabs(h) >= from) {
          ++expected[h > 0 ? colours.first : colours.second];
          break;
        }
    }
  ASSERT_EQ(expected.size(), 10u) << "every band is there";
  const std::string key = heat_legend_svg();
  for (const auto& [colour, leaves] : expected) {
    // the section's window may begin a few rows higher than the block
    EXPECT_GT(drawn_in(svg, colour), 0u) << colour;
    EXPECT_LE(drawn_in(svg, colour), leaves) << colour;
    EXPECT_EQ(drawn_in(svg, colour) * expected.begin()->second,
              leaves * drawn_in(svg, expected.begin()->first))
        << "the same share of each column";
    EXPECT_NE(key.find(colour), std::string::npos) << "the key names it";
  }
}

TEST(Picture, InALanguageOfLongWordsNoEntryOfAKeyRunsIntoTheNext) {
  const auto twice_as_long = [](const Message& words) {
    return english_text(words) + ", " + english_text(words);
  };
  constexpr double k_letter_px = 6.0;  // of 12 px type, on the average
  for (const std::string& key :
       legend_parts_svg(testing::dentin_block(2, 2, 0.2), true, false, twice_as_long)) {
    double width = 0;
    ASSERT_EQ(std::sscanf(key.c_str() + key.find("width='"), "width='%lf", &width), 1);
    std::vector<std::array<double, 3>> entries;  // x, y, end
    for (std::size_t at = key.find("<text"); at != std::string::npos;
         at = key.find("<text", at + 1)) {
      double x = 0, y = 0;
      ASSERT_EQ(std::sscanf(key.c_str() + at, "<text x='%lf' y='%lf'", &x, &y), 2);
      double letters = 0;
      for (std::size_t i = key.find('>', at) + 1; key[i] != '<'; ++i)
        letters += (key[i] & 0xC0) != 0x80 ? 1 : 0;  // of UTF-8
      entries.push_back({x, y, x + k_letter_px * letters});
    }
    ASSERT_FALSE(entries.empty());
    for (std::size_t i = 0; i < entries.size(); ++i) {
      EXPECT_LE(entries[i][2], width) << key;
      if (i > 0 && entries[i][1] == entries[i - 1][1]) {
        EXPECT_GT(entries[i][0] - 21, entries[i - 1][2]) << key;
      }
    }
  }
}

TEST(Picture, TheKeyNamesWhatStandsBesideTheToothWhereAnythingDoes) {
  Tooth tooth = testing::dentin_block(2, 2, 0.2);
  const std::string alone = legend_svg(tooth, true);
  for (const std::uint8_t tissue : {k_gingiva, k_neighbour_enamel})
    EXPECT_EQ(alone.find(tissue_colour(tissue)), std::string::npos);
  tooth.tissues.push_back({k_neighbour_enamel, "neighbour_enamel", true});
  tooth.tissues.push_back({k_gingiva, "gingiva", true});
  const std::string beside = legend_svg(tooth, true);
  for (const std::uint8_t tissue : {k_gingiva, k_neighbour_enamel})
    EXPECT_NE(beside.find(tissue_colour(tissue)), std::string::npos)
        << "in the colour of the sections";
  EXPECT_GT(height_px(beside), height_px(alone)) << "in a row of its own";
  const auto parts = legend_parts_svg(tooth, true);
  ASSERT_EQ(parts.size(), 4u);
  EXPECT_NE(parts[3].find(tissue_colour(k_neighbour_enamel)), std::string::npos);
  for (const auto& part : parts) {
    double width = 0;
    ASSERT_EQ(std::sscanf(part.c_str() + part.find("width='"), "width='%lf", &width), 1);
    EXPECT_LE(width, 330) << "a telephone's width";
  }
}

}  // namespace
}  // namespace cavum::scenarios
