#include "scenarios/file/parse.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "scenarios/file/expression.h"
#include "scenarios/file/rubric_check.h"
#include "tests/engine/support/basics.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

using namespace testing_basics;

const char k_ball[] = "[[zones.target]]\nshape = \"ball\"\nat_mm = [0, 0, 0]\nradius_mm = 1\n";

std::string good() { return testing::scenario_text(k_ball); }

/// `good` with one piece of text replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string text = good();
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Scenario, ReadsWhatItWrites) {
  EXPECT_TRUE(read_scenario(good(), "s.toml").problems.empty());
  const Scenario s = parse_scenario(good(), "s.toml");
  EXPECT_EQ(s.burs, std::vector<std::string>{"round-1.0"});
  EXPECT_EQ(s.perforation.faults.size(), 2u);
  EXPECT_DOUBLE_EQ(s.zones.container.bottom_mm, 0.7);
  EXPECT_EQ(s.rubric.criteria.size(), 3u);
  EXPECT_DOUBLE_EQ(s.rubric.criteria[0].zero, 50);
}

TEST(Scenario, ShippedScenariosAreSound) {
  for (const char* name : {"molar_access.toml", "class_1.toml"})
    EXPECT_NO_THROW(
        static_cast<void>(load_scenario(std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/" + name)))
        << name;
}

/// The mistakes of the good scenario with a piece of its text replaced.
std::vector<Problem> problems(const std::string& from, const std::string& to) {
  return read_scenario(with(from, to), "s.toml").problems;
}

/// That a limit is broken, with what is there and the limit named.
void expect_beyond(const std::vector<Problem>& found, int count, int limit) {
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].mistake, Mistake::too_large);
  EXPECT_TRUE(tells(found[0].message(), count) && tells(found[0].message(), limit))
      << found[0].message();
}

std::string list_of(std::size_t count, const std::string& item) {
  std::string list;
  for (std::size_t i = 0; i < count; ++i) list += item;
  return list;
}

std::string stroke(std::size_t points) {
  return "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"stroke\", width_mm = 1, points_mm = [" +
         list_of(points, "[0, 1], ") + "] }\nbottom = { kind = \"level\", z_mm = 0 }\n";
}

// A tray of 50,000 names took 46 s and 2.1 GB, a stroke of 4,000 points over 100 s.
TEST(ScenarioLimits, LongListsAreRefusedWithTheLimitNamed) {
  expect_beyond(problems("burs = [\"round-1.0\"]", "burs = [" + list_of(50'000, "\"p\", ") + "]"),
                50'000, 100);
  std::string seventeen;
  for (int i = 0; i < 17; ++i) seventeen += "\"p" + std::to_string(i) + "\", ";
  expect_beyond(problems("burs = [\"round-1.0\"]", "burs = [" + seventeen + "]"), 17, 16);
  expect_beyond(problems(k_ball, stroke(4000)), 4000, 100);
  expect_beyond(problems(k_ball, list_of(101, k_ball)), 101, 100);
  EXPECT_TRUE(problems(k_ball, stroke(100)).empty());
}

TEST(ScenarioLimits, LongTextsAreRefusedWithTheLimitNamed) {
  EXPECT_TRUE(problems("title = \"Test\"", "title = \"" + std::string(300, 't') + "\"").empty());
  expect_beyond(problems("title = \"Test\"", "title = \"" + std::string(301, 't') + "\""), 301,
                300);
}

TEST(ScenarioLimits, BodiesAndPointsOfAllZonesAreCountedTogether) {
  EXPECT_TRUE(problems(k_ball, list_of(11, k_ball)).empty());
  expect_beyond(problems(k_ball, list_of(13, k_ball)), 13, 12);
  expect_beyond(problems(k_ball, stroke(60) + stroke(41)), 101, 100);
}

struct Broken {
  const char *from, *to;
  Mistake mistake;
  const char* place;
  std::vector<const char*> names;  ///< what is wrong, and what was meant
};

class BrokenScenario : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenScenario, NamesPlaceMistakeAndRemedy) {
  const auto found = problems(GetParam().from, GetParam().to);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].mistake, GetParam().mistake);
  EXPECT_EQ(place_of(found[0].where), std::string("s.toml:") + GetParam().place);
  EXPECT_FALSE(found[0].what_to_do.empty());
  for (const char* name : GetParam().names)
    EXPECT_TRUE(tells(found[0].message(), name)) << name << ": " << found[0].message();
}

INSTANTIATE_TEST_SUITE_P(
    Each, BrokenScenario,
    ::testing::Values(
        Broken{"max_rpm = 200000", "max_rpm = \"fast\"", Mistake::wrong_type, "5:11", {"max_rpm"}},
        Broken{"time_limit_s = 10",
               "time_limit_s = -3",
               Mistake::out_of_range,
               "6:16",
               {"time_limit_s"}},
        Broken{"title = \"Test\"", "titel = \"Test\"", Mistake::missing, "1:1", {"title"}},
        Broken{"burs = [\"round-1.0\"]", "burs = []", Mistake::missing, "4:8", {"burs"}},
        Broken{"99\"", "99 &&\"", Mistake::condition, "10:17", {"complete_when"}},
        Broken{"\"target_removed_percent >=",
               "\"target_remove_percent >=",
               Mistake::unknown_quantity,
               "10:17",
               {"target_remove_percent", "target_removed_percent"}},
        Broken{">= 99\"", "= 99\"", Mistake::condition, "10:17", {"complete_when"}},
        Broken{"target_removed_percent >= 99",
               "depth_mm^2 > 3",
               Mistake::condition,
               "10:17",
               {"complete_when"}},
        Broken{"faults = [\"pulp\"", "faults = [7", Mistake::wrong_type, "13:11", {"faults"}},
        Broken{"aims = []", "aims = [\"pulp\"]", Mistake::contradictory, "13:10", {"pulp"}},
        Broken{"sides_mm = 0.8", "sides_mm = 0.1", Mistake::contradictory, "17:1", {}},
        Broken{
            "shape = \"ball\"", "shape = \"bal\"", Mistake::unknown_name, "21:9", {"bal", "ball"}},
        Broken{"radius_mm = 1",
               "radius_mm = 1\ncolour = 3",
               Mistake::unknown_key,
               "24:1",
               {"colour", "shape", "combine", "at_mm", "radius_mm"}},
        Broken{"at_mm = [0, 0, 0]", "at_mm = [0, 0]", Mistake::wrong_type, "22:9", {"at_mm"}},
        Broken{"at_mm = [0, 0, 0]", "at_mm = [0, nan, 0]", Mistake::wrong_type, "22:9", {"at_mm"}},
        Broken{"rule = \"compensatory\"",
               "rule = \"strict\"",
               Mistake::unknown_name,
               "26:8",
               {"strict", "compensatory", "non-compensatory"}},
        Broken{"metric = \"outside_mm3\"",
               "metric = \"outsid_mm3\"",
               Mistake::unknown_measure,
               "43:10",
               {"outsid_mm3", "outside_mm3"}},
        Broken{"full = 100\nzero = 50", "full = 50\nzero = 50", Mistake::contradictory, "33:8", {}},
        Broken{"id = \"sides\"", "id = \"removed\"", Mistake::duplicate, "35:1", {"removed"}},
        Broken{"id = \"only\"", "id = \"Only one\"", Mistake::bad_name, "8:6", {"Only one"}},
        Broken{"[zones.leeway]", "[zones.leeway", Mistake::not_toml, "14:14", {}}));

TEST(Scenario, NamesAllMistakesInTheOrderOfTheFileAndThrowsWithTheFirst) {
  std::string text = with("max_rpm = 200000", "max_rpm = 1");
  text.replace(text.find("shape = \"ball\""), 14, "shape = \"blob\"");
  text.replace(text.find("pass_percent = 60"), 17, "pass_percent = 160");
  const auto found = read_scenario(text, "s.toml").problems;
  ASSERT_GE(found.size(), 3u);
  for (std::size_t i = 1; i < found.size(); ++i)
    EXPECT_LE(found[i - 1].where.line, found[i].where.line);
  const auto thrown = thrown_by([&] { static_cast<void>(parse_scenario(text, "s.toml")); });
  ASSERT_TRUE(thrown);
  EXPECT_EQ(thrown->where(), Message(found[0].where));
  EXPECT_EQ(thrown->problem(), found[0].what);
  EXPECT_TRUE(tells(thrown->advice(), static_cast<int>(found.size()) - 1))
      << "how many more there are";
}

TEST(Rubric, IsReadAloneOrUnderItsHeading) {
  const std::string body =
      "rule = \"non-compensatory\"\npass_percent = 70\n[[CRITERIA]]\nid = \"a\"\nmetric = \"dice\"\nfull = 1\nzero = 0\npoints = 5\n";
  std::string alone = body, under = "[rubric]\n" + body;
  alone.replace(alone.find("CRITERIA"), 8, "criteria");
  under.replace(under.find("CRITERIA"), 8, "rubric.criteria");
  for (const auto& text : {alone, under}) {
    const RubricSpec r = parse_rubric(text, "r.toml");
    EXPECT_FALSE(r.compensatory);
    EXPECT_DOUBLE_EQ(r.pass_percent, 70);
    ASSERT_EQ(r.criteria.size(), 1u);
  }
  EXPECT_THROW(static_cast<void>(parse_rubric("pass_percent = 70", "r.toml")), Error);
}

TEST(Expression, KnowsArithmeticAndLogicOnly) {
  std::vector<std::string> names{"a", "b"};
  std::vector<double> values{2, 3};
  const Expression e("a * b > 5 && min(a, b) == 2 && abs(-a) < max(a, b) ? 7 : 1", names, values);
  EXPECT_DOUBLE_EQ(e.value(), 7);
  values[0] = 1;
  EXPECT_DOUBLE_EQ(e.value(), 1);
  for (const char* text :
       {"sin(a)", "exp(a)", "sqrt(a)", "rnd()", "a ^ 2", "_pi", "a = 3", "c", "a +", ""})
    EXPECT_THROW(Expression(text, names, values), std::runtime_error) << text;
  EXPECT_DOUBLE_EQ(Expression("a / 0", names, values).value(), 0);
}

TEST(ParseRubric, NamesEveryMistakeAtOnceEachWithItsPlace) {
  const std::string text =
      "rule = \"compensatory\"\npass_percent = 400\n[[criteria]]\nid = \"a\"\nmetric = \"dise\"\nfull = 1\nzero = 1\npoints = 10\n";
  try {
    static_cast<void>(parse_rubric(text, "r.toml"));
    FAIL();
  } catch (const ProblemsError& e) {
    std::vector<std::string> places;
    for (const Problem& p : e.problems()) places.push_back(place_of(p.where));
    EXPECT_EQ(places, (std::vector<std::string>{"r.toml:2:16", "r.toml:5:10", "r.toml:7:8"}));
    EXPECT_TRUE(tells(e.advice(), 2)) << "how many more there are";
  }
}

TEST(ParseRubric, MeasuresOfWhatTheExamDoesNotHaveAreNamedWithTheirPlace) {
  const std::string text = testing::scenario_text(
      "[[zones.target]]\nshape = \"ball\"\nat_mm = [0, 0, 0]\nradius_mm = 1\n");
  const Scenario s = parse_scenario(text, "s.toml");
  const Tooth tooth = testing::dentin_block(2, 2, 0.1);
  std::string rubric = "rule = \"compensatory\"\npass_percent = 60\n";
  const std::vector<std::string> absent{"touched_pulpa_mm3", "protected_mm3", "overhang_mm3",
                                        "canals_covered_percent", "force_over_limit_s"};
  std::vector<std::string> all = absent;
  for (const char* there :
       {"container_mm3", "leeway_sides_mm3", "perforated", "touched_dentin_mm3", "dice"})
    all.emplace_back(there);
  for (const auto& metric : all)
    rubric += "[[criteria]]\nid = \"" + metric + "\"\nmetric = \"" + metric +
              "\"\nfull = 0\nzero = 1\npoints = 1\n";
  const auto found = not_in_this_exam(parse_rubric(rubric, "r.toml"), s, tooth);
  ASSERT_EQ(found.size(), absent.size());
  for (std::size_t i = 0; i < absent.size(); ++i) {
    EXPECT_TRUE(tells(found[i].what, absent[i])) << found[i].message();
    EXPECT_EQ(place_of(found[i].where), "r.toml:" + std::to_string(5 + 6 * i) + ":10");
  }
  EXPECT_TRUE(not_in_this_exam(s.rubric, s, tooth).empty());
}

}  // namespace
}  // namespace cavum::scenarios
