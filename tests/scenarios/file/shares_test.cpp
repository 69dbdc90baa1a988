// Criteria that charge one mistake twice, and say so or not.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "scenarios/file/measures.h"
#include "scenarios/file/rubric_check.h"
#include "tests/engine/support/basics.h"

namespace cavum::scenarios {
namespace {

std::string criterion(const std::string& id, const std::string& metric,
                      const std::string& more = "", int points = 10) {
  return fmt::format(
      "[[criteria]]\nid = \"{}\"\nmetric = \"{}\"\nfull = 0\nzero = 1\npoints = {}\n{}\n", id,
      metric, points, more);
}
std::vector<Problem> twice(const std::string& criteria) {
  return charged_twice(
      parse_rubric("rule = \"compensatory\"\npass_percent = 60\n" + criteria, "r.toml"));
}

TEST(Shares, TwoThatCountTheSameAreWarnedOfUnlessOneNamesTheOther) {
  const auto problems =
      twice(criterion("elsewhere", "outside_mm3") + criterion("guarded", "protected_mm3"));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_TRUE(problems[0].warning);
  EXPECT_EQ(problems[0].where, (FileLocation{"r.toml", 12, 10}));
  for (const char* name : {"guarded", "elsewhere", "protected_mm3", "outside_mm3"})
    EXPECT_TRUE(testing_basics::tells(problems[0].what, name)) << name;
  EXPECT_TRUE(testing_basics::tells(problems[0].what_to_do, "elsewhere"));
  EXPECT_TRUE(twice(criterion("elsewhere", "outside_mm3") +
                    criterion("guarded", "protected_mm3", "shares_with = [\"elsewhere\"]"))
                  .empty());
  EXPECT_TRUE(twice(criterion("elsewhere", "outside_mm3", "shares_with = [\"guarded\"]") +
                    criterion("guarded", "protected_mm3"))
                  .empty());
  EXPECT_TRUE(twice(criterion("elsewhere", "outside_mm3") +
                    criterion("guarded", "protected_mm3", "critical_above = 0.5", 0))
                  .empty())
      << "what gives no points charges none";
}

TEST(Shares, WallsFloorAndVolumesAreToldApart) {
  EXPECT_EQ(
      twice(criterion("a", "container_sides_mm3") + criterion("b", "mesial_max_over_mm")).size(),
      1u);
  EXPECT_EQ(
      twice(criterion("a", "container_sides_mm3") + criterion("b", "floor_max_over_mm")).size(),
      0u);
  EXPECT_EQ(
      twice(criterion("a", "container_bottom_mm3") + criterion("b", "walls_max_over_mm")).size(),
      1u);
  EXPECT_EQ(twice(criterion("a", "container_sides_mm3") + criterion("b", "container_bottom_mm3") +
                  criterion("c", "outside_mm3"))
                .size(),
            0u);
  EXPECT_EQ(twice(criterion("a", "container_mm3") + criterion("b", "overcut_mm3") +
                  criterion("c", "dice"))
                .size(),
            3u);
}

TEST(Shares, IdThatIsNoOtherCriterionIsAMistake) {
  for (const char* wrong : {"walls", "itself"}) {
    const auto refused = testing_basics::thrown_by([&] {
      static_cast<void>(
          twice(criterion("wall", "container_sides_mm3") +
                criterion("itself", "outside_mm3", fmt::format("shares_with = [\"{}\"]", wrong))));
    });
    EXPECT_EQ(testing_basics::code_of(refused), Mistake::unknown_criterion) << wrong;
    EXPECT_TRUE(testing_basics::tells(refused, "itself") && testing_basics::tells(refused, wrong));
  }
}

TEST(Shares, MeasuresOfTheSameUnitSayWhatTheyCount) {
  for (const auto& m : measures())
    if (m.unit == std::string("mm3") && m.tissue.empty() && m.name != "soft_tissue_outside_mm3") {
      EXPECT_NE(m.counts, k_counts_nothing) << m.name;
      EXPECT_FALSE(counts_text(m.counts).items.empty());
    }
}

}  // namespace
}  // namespace cavum::scenarios
