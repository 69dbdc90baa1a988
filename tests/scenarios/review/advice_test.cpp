// What `cavum scenario check` warns of beyond the golden files: what depends on the tooth.
#include "scenarios/review/advice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/base/file.h"
#include "scenarios/review/check.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

std::vector<std::string> warnings(const std::string& target, const Tooth& tooth) {
  const std::string file = std::string(CAVUM_SOURCE_DIR) + "/data/points/round-1.0.toml";
  const Scenario s = parse_scenario(testing::scenario_text(target), "s.toml");
  ExpertsPart expert;
  std::vector<std::string> said;
  for (const auto& p : advise(s, tooth, build_zones(s, tooth), {parse_diamond_point(read_text_file(file), file)}, expert))
    said.push_back(english_text(p.what));
  return said;
}

bool any_begins(const std::vector<std::string>& said, const std::string& with) {
  return std::any_of(said.begin(), said.end(), [&](const std::string& w) { return w.starts_with(with); });
}

std::string hole(const std::string& radius) {
  return "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"circle\", radius_mm = " + radius +
         " }\nbottom = { kind = \"below_surface\", depth_mm = 1.2 }\n";
}

TEST(Advice, SaysThatABuriedTargetIsBuriedNotThatPointsAreTooThick) {
  const std::string ball = "[[zones.target]]\nshape = \"ball\"\nat_mm = [0, 0, -2]\nradius_mm = 1\n";
  const auto said = warnings(ball, testing::dentin_block(3, 4, 0.05));
  EXPECT_TRUE(any_begins(said, "the target lies buried"));
  EXPECT_FALSE(any_begins(said, "no allowed point"));
  EXPECT_FALSE(any_begins(said, "the point"));
  EXPECT_FALSE(any_begins(warnings(hole("1.0"), testing::dentin_block(3, 4, 0.05)), "the target lies buried"));
}

TEST(Advice, OnCoarseLeavesAPointIsNotSaidToMissWhatItReachesOnFineOnes) {
  for (const char* radius : {"0.55", "0.6", "0.7"}) {
    const auto fine = warnings(hole(radius), testing::dentin_block(3, 3, 0.05));
    ASSERT_FALSE(any_begins(fine, "no allowed point")) << radius;
    for (const double leaf : {0.2, 0.3}) {
      const auto coarse = warnings(hole(radius), testing::dentin_block(3, 3, leaf));
      EXPECT_FALSE(any_begins(coarse, "no allowed point")) << radius << " " << leaf;
      EXPECT_TRUE(any_begins(coarse, "the tooth's leaves are " + std::string(leaf == 0.2 ? "0.2" : "0.3") + " mm wide"));
    }
    EXPECT_FALSE(any_begins(fine, "the tooth's leaves"));
  }
}

TEST(Advice, SaysThatNoCriterionMeasuresWhatIsProtected) {
  const std::string guard = "[[zones.protected]]\nshape = \"box\"\nat_mm = [2.5, 0, -2]\nsize_mm = [1, 1, 1]\n";
  const char* for_nothing = "what is protected can be removed for nothing";
  const Tooth block = testing::dentin_block(3, 4, 0.1);
  EXPECT_FALSE(any_begins(warnings(hole("1.0") + guard, block), for_nothing));  // outside_mm3 counts it
  std::string text = testing::scenario_text(hole("1.0") + guard);
  const auto at = text.find("metric = \"outside_mm3\"");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 22, "metric = \"removed_mm3\"");
  const Scenario s = parse_scenario(text, "s.toml");
  ExpertsPart expert;
  std::vector<std::string> said;
  for (const auto& p : advise(s, block, build_zones(s, block), {}, expert)) said.push_back(english_text(p.what));
  EXPECT_TRUE(any_begins(said, for_nothing));
}

TEST(Advice, SaysThatTheCavityHasNoSuchWall) {
  const auto said = [](const char* metric) {
    std::string text = testing::scenario_text("[[zones.target]]\nshape = \"box\"\nat_mm = [2, 0, 0]\nsize_mm = [3, 2, 2]\n");  // out through the side
    const std::string from = "metric = \"outside_mm3\"";
    text.replace(text.find(from), from.size(), std::string("metric = \"") + metric + "\"");
    const Tooth block = testing::dentin_block(3, 4, 0.1);
    const Scenario s = parse_scenario(text, "s.toml");
    ExpertsPart expert;
    for (const auto& p : advise(s, block, build_zones(s, block), {}, expert))
      if (english_text(p.what).starts_with("the cavity has no")) return english_text(p.what);
    return std::string();
  };
  for (const char* metric : {"mesial_mean_mm", "mesial_p95_mm", "mesial_max_under_mm"})
    EXPECT_EQ(said(metric), "the cavity has no mesial wall in this tooth: nobody can win these points");
  EXPECT_EQ(said("mesial_max_over_mm"), "the cavity has no mesial wall in this tooth: nobody can lose these points");
  for (const char* metric : {"distal_p95_mm", "buccal_mean_mm", "floor_max_over_mm", "side_walls_p95_mm"}) EXPECT_EQ(said(metric), "");
}

TEST(Advice, SaysThatAScenarioWasWrittenForAnotherTooth) {
  const std::string folder = std::string(CAVUM_SOURCE_DIR) + "/tests/scenarios/broken/", file = folder + "target_holds_pulp.toml";
  const std::string text = read_text_file(file), block = std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block.cvt";
  const auto said = [&](const std::string& written_for) {
    std::string other = text;
    other.replace(other.find("block.cvt"), 9, written_for);
    std::vector<std::string> list;
    for (const auto& p : check_whole(other, file, block).problems) list.push_back(english_text(p.what));
    return list;
  };
  EXPECT_TRUE(any_begins(said("molar.cvt"), "the scenario was written for molar.cvt, and is checked on block.cvt"));
  EXPECT_FALSE(any_begins(said("block.cvt"), "the scenario was written for"));
  EXPECT_FALSE(any_begins(said("teeth/block.cvt"), "the scenario was written for"));
}

}  // namespace
}  // namespace cavum::scenarios
