// What `cavum scenario check` warns of beyond the golden files: what depends on the tooth.
#include "scenarios/review/advice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/base/file.h"
#include "scenarios/review/check.h"
#include "tests/engine/support/basics.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

std::vector<Problem> warnings(const std::string& target, const Tooth& tooth) {
  const std::string file = std::string(CAVUM_SOURCE_DIR) + "/data/burs/round-1.0.toml";
  const Scenario s = parse_scenario(testing::scenario_text(target), "s.toml");
  ExpertsPart expert;
  return advise(s, tooth, build_zones(s, tooth), {parse_bur(read_text_file(file), file)}, expert);
}

/// Whether there is one of this kind in a line of the file that begins so.
bool any_at(const std::vector<Problem>& found, Mistake mistake, const std::string& text,
            const std::string& line) {
  const auto at = static_cast<int>(
      1 + std::count(text.begin(),
                     text.begin() + static_cast<std::ptrdiff_t>(text.find("\n" + line) + 1), '\n'));
  return std::any_of(found.begin(), found.end(),
                     [&](const Problem& p) { return p.mistake == mistake && p.where.line == at; });
}
/// That the target or a bur of the tray cannot be reached.
bool any_unreachable(const std::vector<Problem>& found, const std::string& target,
                     const char* line) {
  return any_at(found, Mistake::unreachable, testing::scenario_text(target), line);
}
constexpr const char *k_target = "[[zones.target]]", *k_tray = "burs";

std::string hole(const std::string& radius) {
  return "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"circle\", radius_mm = " +
         radius + " }\nbottom = { kind = \"below_surface\", depth_mm = 1.2 }\n";
}

TEST(Advice, SaysThatABuriedTargetIsBuriedNotThatBursAreTooThick) {
  const std::string ball =
      "[[zones.target]]\nshape = \"ball\"\nat_mm = [0, 0, -2]\nradius_mm = 1\n";
  const auto found = warnings(ball, testing::dentin_block(3, 4, 0.05));
  EXPECT_TRUE(any_unreachable(found, ball, k_target));
  EXPECT_FALSE(any_unreachable(found, ball, k_tray));
  EXPECT_FALSE(any_unreachable(warnings(hole("1.0"), testing::dentin_block(3, 4, 0.05)),
                               hole("1.0"), k_target));
}

TEST(Advice, OnCoarseLeavesABurIsNotSaidToMissWhatItReachesOnFineOnes) {
  for (const char* radius : {"0.55", "0.6", "0.7"}) {
    const auto fine = warnings(hole(radius), testing::dentin_block(3, 3, 0.05));
    const auto tells_leaf = [](const std::vector<Problem>& found, double mm) {
      return std::any_of(found.begin(), found.end(),
                         [&](const Problem& p) { return testing_basics::tells(p.what, mm); });
    };
    ASSERT_FALSE(any_unreachable(fine, hole(radius), k_tray)) << radius;
    for (const double leaf : {0.2, 0.3}) {
      const auto coarse = warnings(hole(radius), testing::dentin_block(3, 3, leaf));
      EXPECT_FALSE(any_unreachable(coarse, hole(radius), k_tray)) << radius << " " << leaf;
      EXPECT_TRUE(tells_leaf(coarse, leaf));
    }
    EXPECT_FALSE(tells_leaf(fine, 0.05));
  }
}

TEST(Advice, SaysThatNoCriterionMeasuresWhatIsProtected) {
  const std::string guard =
      "[[zones.protected]]\nshape = \"box\"\nat_mm = [2.5, 0, -2]\nsize_mm = [1, 1, 1]\n";
  const Tooth block = testing::dentin_block(3, 4, 0.1);
  std::string text = testing::scenario_text(hole("1.0") + guard);
  EXPECT_FALSE(any_at(warnings(hole("1.0") + guard, block), Mistake::idle, text,
                      "[[zones.protected]]"));  // outside_mm3 counts it
  const auto at = text.find("metric = \"outside_mm3\"");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 22, "metric = \"removed_mm3\"");
  const Scenario s = parse_scenario(text, "s.toml");
  ExpertsPart expert;
  EXPECT_TRUE(any_at(advise(s, block, build_zones(s, block), {}, expert), Mistake::idle, text,
                     "[[zones.protected]]"));
}

TEST(Advice, SaysThatTheCavityHasNoSuchWall) {
  const auto said = [](const char* metric) {
    std::string text = testing::scenario_text(
        "[[zones.target]]\nshape = \"box\"\nat_mm = [2, 0, 0]\nsize_mm = [3, 2, 2]\n");  // out
                                                                                         // through
                                                                                         // the side
    const std::string from = "metric = \"outside_mm3\"";
    text.replace(text.find(from), from.size(), std::string("metric = \"") + metric + "\"");
    const Tooth block = testing::dentin_block(3, 4, 0.1);
    const Scenario s = parse_scenario(text, "s.toml");
    ExpertsPart expert;
    for (const auto& p : advise(s, block, build_zones(s, block), {}, expert))
      if (testing_basics::tells(p.what, wall_text(static_cast<std::size_t>(Wall::mesial), {})))
        return std::optional(p.mistake);
    return std::optional<Mistake>();
  };
  for (const char* metric : {"mesial_mean_mm", "mesial_p95_mm", "mesial_max_under_mm"})
    EXPECT_EQ(said(metric), Mistake::unreachable) << metric;
  EXPECT_EQ(said("mesial_max_over_mm"), Mistake::idle);
  for (const char* metric :
       {"distal_p95_mm", "buccal_mean_mm", "floor_max_over_mm", "side_walls_p95_mm"})
    EXPECT_FALSE(said(metric)) << metric;
}

TEST(Advice, SaysThatAScenarioWasWrittenForAnotherTooth) {
  const std::string folder = std::string(CAVUM_SOURCE_DIR) + "/tests/scenarios/broken/",
                    file = folder + "target_holds_pulp.toml";
  const std::string text = read_text_file(file),
                    block = std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block.cvt";
  const auto said = [&](const std::string& written_for) {
    std::string other = text;
    other.replace(other.find("block.cvt"), 9, written_for);
    const auto found = check_whole(other, file, block).problems;
    return std::any_of(found.begin(), found.end(), [](const Problem& p) {
      return p.mistake == Mistake::contradictory && testing_basics::tells(p.what, "block.cvt");
    });
  };
  EXPECT_TRUE(said("molar.cvt"));
  EXPECT_FALSE(said("block.cvt"));
  EXPECT_FALSE(said("teeth/block.cvt"));
}

}  // namespace
}  // namespace cavum::scenarios
