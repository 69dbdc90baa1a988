#include "scenarios/file/measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "engine/base/error.h"
#include "scenarios/file/names.h"
#include "scenarios/file/parse.h"
#include "tests/engine/support/basics.h"

namespace cavum::scenarios {
namespace {

TEST(Measures, HaveEachItsOwnNameThatEndsInItsUnit) {
  std::set<std::string> names;
  for (const auto& m : measures()) {
    EXPECT_TRUE(names.insert(m.name).second) << m.name;
    EXPECT_FALSE(m.words.empty()) << m.name;
    const std::string unit = m.unit, ending = unit == "%"    ? "_percent"
                                              : unit == "N"  ? "_n"
                                              : unit.empty() ? ""
                                                             : "_" + unit;
    EXPECT_TRUE(m.name.ends_with(ending)) << m.name << " " << unit;
    if (unit.empty()) {
      for (const char* other : {"_mm", "_mm3", "_s", "_n", "_deg", "_percent"})
        EXPECT_FALSE(m.name.ends_with(other)) << m.name;
    }
  }
}

TEST(Measures, OfTheFamiliesAreFoundByTheirNames) {
  // what rubrics of schools name: five walls with four figures each, and those of several walls
  // that were asked for
  for (const char* wall : {"mesial", "distal", "buccal", "lingual", "floor"})
    for (const char* figure : {"_mean_mm", "_p95_mm", "_max_over_mm", "_max_under_mm"}) {
      const auto m = find_measure(std::string(wall) + figure);
      ASSERT_TRUE(m) << wall << figure;
      EXPECT_EQ(m->walls, 1u);
      EXPECT_EQ(m->of_floor, wall == std::string("floor"));
    }
  for (const char* several : {"side_walls_max_over_mm", "side_walls_max_under_mm",
                              "side_walls_p95_mm", "walls_max_over_mm", "walls_max_under_mm"})
    EXPECT_TRUE(find_measure(several)) << several;
  EXPECT_FALSE(find_measure("side_walls_mean_mm"));
  EXPECT_FALSE(find_measure("opening_mean_mm"));
  EXPECT_EQ(find_measure("side_walls_p95_mm")->walls, 4u);
  EXPECT_EQ(find_measure("walls_max_over_mm")->walls, 5u);
  const auto composite = find_measure("touched_composite_mm3");
  ASSERT_TRUE(composite);
  EXPECT_EQ(composite->tissue, "composite");
  EXPECT_STREQ(composite->unit, "mm3");
  for (const char* none :
       {"touched_pulp", "touched__mm3", "touched_mm3", "touched_", "canals_covered", ""})
    EXPECT_FALSE(find_measure(none)) << none;
  EXPECT_THROW(static_cast<void>(known_measure("touched_pulp")), Error);
}

TEST(Measures, SayWhichWayIsBetterAndWhatTheyJudge) {
  const auto better = [](const char* name) { return known_measure(name).better; };
  EXPECT_EQ(better("target_removed_percent"), Better::more);
  EXPECT_EQ(better("steps_completed"), Better::more);
  EXPECT_EQ(better("dentin_over_pulp_mm"), Better::more);
  EXPECT_EQ(better("canals_covered_percent"), Better::less);
  EXPECT_EQ(better("walls_max_over_mm"), Better::less);
  EXPECT_EQ(better("side_walls_p95_mm"), Better::by_task);
  EXPECT_EQ(better("floor_mean_mm"), Better::by_task);
  EXPECT_EQ(better("touched_enamel_mm3"), Better::by_task);
  EXPECT_EQ(known_measure("overhang_mm3").judges, Judges::work);
  EXPECT_EQ(known_measure("outside_mm3").judges, Judges::care);
}

TEST(Measures, EndWhereTheExamDoes) {
  ExamExtent exam;
  exam.limit_s = 300;
  exam.container_sides_mm3 = 2.5;
  exam.tissue_mm3["pulp"] = 7;
  const auto most = [&](const char* name) { return most_of(known_measure(name), exam); };
  EXPECT_EQ(most("time_s"), 300.0);
  EXPECT_EQ(most("container_sides_mm3"), 2.5);
  EXPECT_EQ(most("canals_covered_percent"), 100.0);
  EXPECT_EQ(most("touched_pulp_mm3"), 7.0);
  EXPECT_EQ(most("touched_composite_mm3"), std::nullopt);
  EXPECT_EQ(most("depth_mm"), std::nullopt);
  EXPECT_EQ(most("lingual_max_over_mm"), k_no_end);
}

TEST(Measures, ATissueWithoutItsUnitIsNoMeasureButWasTakenOnce) {
  const std::string rubric =
      "rule = \"compensatory\"\npass_percent = 60\n[[criteria]]\nid = \"a\"\nmetric = \"touched_pulp\"\nfull = 0\nzero = 1\npoints = 5\n";
  try {
    static_cast<void>(parse_rubric(rubric, "r.toml"));
    FAIL() << "taken";
  } catch (const ProblemsError& e) {
    EXPECT_EQ(e.code(), Mistake::unknown_measure);
    EXPECT_EQ(e.where(), Message(FileLocation{"r.toml", 5, 10}));
    EXPECT_TRUE(testing_basics::tells(e.problem(), "touched_pulp") &&
                testing_basics::tells(e.advice(), "touched_pulp_mm3"));
  }
}

}  // namespace
}  // namespace cavum::scenarios
