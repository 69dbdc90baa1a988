#include "scenarios/file/parse.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "scenarios/file/expression.h"
#include "scenarios/file/rubric_check.h"
#include "scenarios/file/template.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

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
  EXPECT_TRUE(check_scenario(good(), "s.toml").empty());
  const Scenario s = parse_scenario(good(), "s.toml");
  EXPECT_EQ(s.points, std::vector<std::string>{"round-1.0"});
  EXPECT_EQ(s.perforation.faults.size(), 2u);
  EXPECT_DOUBLE_EQ(s.zones.container.bottom_mm, 0.7);
  EXPECT_EQ(s.rubric.criteria.size(), 3u);
  EXPECT_DOUBLE_EQ(s.rubric.criteria[0].zero, 50);
}

TEST(Scenario, TemplateAndShippedScenariosAreSound) {
  for (const auto& p : check_scenario(block_task("class_1"), "template")) ADD_FAILURE() << english_text(p.message());
  for (const char* name : {"molar_access.toml", "class_1.toml"})
    EXPECT_NO_THROW(static_cast<void>(load_scenario(std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/" + name))) << name;
}

/// The first problem of the good scenario with a piece of its text replaced.
std::string first_problem(const std::string& from, const std::string& to) {
  const auto problems = check_scenario(with(from, to), "s.toml");
  return problems.empty() ? "" : english_text(problems[0].message());
}

std::string list_of(std::size_t count, const std::string& item) {
  std::string list;
  for (std::size_t i = 0; i < count; ++i) list += item;
  return list;
}

std::string stroke(std::size_t points) {
  return "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"stroke\", width_mm = 1, points_mm = [" + list_of(points, "[0, 1], ") +
         "] }\nbottom = { kind = \"level\", z_mm = 0 }\n";
}

// A tray of 50,000 names took 46 s and 2.1 GB, a stroke of 4,000 points over 100 s.
TEST(ScenarioLimits, LongListsAreRefusedWithTheLimitNamed) {
  const std::string tray = first_problem("points = [\"round-1.0\"]", "points = [" + list_of(50'000, "\"p\", ") + "]");
  EXPECT_NE(tray.find("'points' has 50000 items; list at most 100"), std::string::npos) << tray;
  std::string seventeen;
  for (int i = 0; i < 17; ++i) seventeen += "\"p" + std::to_string(i) + "\", ";
  EXPECT_EQ(first_problem("points = [\"round-1.0\"]", "points = [" + seventeen + "]"), "s.toml:4:10: 'points' has 17 items; list at most 16");
  const std::string outline = first_problem(k_ball, stroke(4000));
  EXPECT_NE(outline.find("'points_mm' has 4000 items; list at most 100"), std::string::npos) << outline;
  const std::string bodies = first_problem(k_ball, list_of(101, k_ball));
  EXPECT_NE(bodies.find("'target' has 101 items; list at most 100"), std::string::npos) << bodies;
  EXPECT_EQ(first_problem(k_ball, stroke(100)), "");
}

TEST(ScenarioLimits, LongTextsAreRefusedWithTheLimitNamed) {
  EXPECT_EQ(first_problem("title = \"Test\"", "title = \"" + std::string(300, 't') + "\""), "");
  EXPECT_NE(first_problem("title = \"Test\"", "title = \"" + std::string(301, 't') + "\"").find("has 301 bytes, the limit is 300"),
            std::string::npos);
}

TEST(ScenarioLimits, BodiesAndPointsOfAllZonesAreCountedTogether) {
  EXPECT_EQ(first_problem(k_ball, list_of(11, k_ball)), "");
  const std::string bodies = first_problem(k_ball, list_of(13, k_ball)), points = first_problem(k_ball, stroke(60) + stroke(41));
  EXPECT_NE(bodies.find(" bodies; use at most 12"), std::string::npos) << bodies;
  EXPECT_NE(points.find("the outlines have 101 points in all; use at most 100"), std::string::npos) << points;
}

struct Broken {
  const char *from, *to, *message;
};

class BrokenScenario : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenScenario, NamesPlaceMistakeAndRemedy) {
  const auto problems = check_scenario(with(GetParam().from, GetParam().to), "s.toml");
  ASSERT_FALSE(problems.empty());
  EXPECT_EQ(english_text(problems[0].message()), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Each, BrokenScenario,
    ::testing::Values(
        Broken{"max_rpm = 200000", "max_rpm = \"fast\"", "s.toml:5:11: 'max_rpm' is a text; write a number"},
        Broken{"time_limit_s = 10", "time_limit_s = -3", "s.toml:6:16: 'time_limit_s' is -3; use 0.001 to 36000"},
        Broken{"title = \"Test\"", "titel = \"Test\"", "s.toml:1:1: the scenario has no 'title'; add it"},
        Broken{"points = [\"round-1.0\"]", "points = []", "s.toml:4:10: 'points' is empty; list at least one"},
        Broken{"99\"", "99 &&\"",
               "s.toml:10:17: 'complete_when' cannot be read (Unexpected end of expression at position 32); write for example "
               "\"target_removed_percent >= 90 && depth_mm < 5\""},
        Broken{"\"target_removed_percent >=", "\"target_remove_percent >=",
               "s.toml:10:17: 'complete_when' uses the unknown quantity 'target_remove_percent'; did you mean 'target_removed_percent'?"},
        Broken{">= 99\"", "= 99\"",
               "s.toml:10:17: 'complete_when' cannot be read (a single = assigns: compare with ==); write for example "
               "\"target_removed_percent >= 90 && depth_mm < 5\""},
        Broken{"target_removed_percent >= 99", "depth_mm^2 > 3",
               "s.toml:10:17: 'complete_when' cannot be read (powers (^) are not available: multiply instead); write for example "
               "\"target_removed_percent >= 90 && depth_mm < 5\""},
        Broken{"faults = [\"pulp\"", "faults = [7", "s.toml:13:11: 'faults' holds a number; write a text in quotes"},
        Broken{"aims = []", "aims = [\"pulp\"]", "s.toml:13:10: 'pulp' is both an aim and a fault; keep it in one of the two lists"},
        Broken{"sides_mm = 0.8", "sides_mm = 0.1",
               "s.toml:17:1: the container is narrower than the leeway; make it at least as wide: it is measured from the target too"},
        Broken{"shape = \"ball\"", "shape = \"bal\"", "s.toml:21:9: 'shape' is \"bal\"; did you mean 'ball'?"},
        Broken{"radius_mm = 1", "radius_mm = 1\ncolour = 3",
               "s.toml:24:1: [[zones.target]] has an unknown key 'colour'; use one of shape, combine, at_mm, radius_mm"},
        Broken{"at_mm = [0, 0, 0]", "at_mm = [0, 0]", "s.toml:22:9: 'at_mm' is not a list of 3 numbers within 1000 mm; write [x, y, z]"},
        Broken{"at_mm = [0, 0, 0]", "at_mm = [0, nan, 0]", "s.toml:22:9: 'at_mm' is not a list of 3 numbers within 1000 mm; write [x, y, z]"},
        Broken{"rule = \"compensatory\"", "rule = \"strict\"", "s.toml:26:8: 'rule' is \"strict\"; use one of compensatory, non-compensatory"},
        Broken{"metric = \"outside_mm3\"", "metric = \"outsid_mm3\"", "s.toml:43:10: there is no measure 'outsid_mm3'; did you mean 'outside_mm3'?"},
        Broken{"full = 100\nzero = 50", "full = 50\nzero = 50",
               "s.toml:33:8: 'full' and 'zero' are the same value; points run linearly from one to the other: make them differ"},
        Broken{"id = \"sides\"", "id = \"removed\"", "s.toml:35:1: two criteria are called 'removed'; give each its own id"},
        Broken{"id = \"only\"", "id = \"Only one\"", "s.toml:8:6: 'id' is \"Only one\"; use small letters, digits, _ and -"},
        Broken{"[zones.leeway]", "[zones.leeway",
               "s.toml:14:14: this is not TOML (Error while parsing table header: expected ']', saw '\\n'); correct the line"}));

TEST(Scenario, NamesAllMistakesInTheOrderOfTheFileAndThrowsWithTheFirst) {
  std::string text = with("max_rpm = 200000", "max_rpm = 1");
  text.replace(text.find("shape = \"ball\""), 14, "shape = \"blob\"");
  text.replace(text.find("pass_percent = 60"), 17, "pass_percent = 160");
  const auto problems = check_scenario(text, "s.toml");
  ASSERT_GE(problems.size(), 3u);
  for (std::size_t i = 1; i < problems.size(); ++i) EXPECT_LE(problems[i - 1].where.line, problems[i].where.line);
  try {
    static_cast<void>(parse_scenario(text, "s.toml"));
    FAIL() << "a broken scenario was accepted";
  } catch (const Error& e) {
    const std::string said = e.what();
    EXPECT_TRUE(said.starts_with(english_text(problems[0].message()) + " (and " + std::to_string(problems.size() - 1) + " more")) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  }
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
  for (const char* text : {"sin(a)", "exp(a)", "sqrt(a)", "rnd()", "a ^ 2", "_pi", "a = 3", "c", "a +", ""})
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
    ASSERT_EQ(e.problems().size(), 3u);
    EXPECT_EQ(english_text(e.problems()[0].where), "r.toml:2:16");
    EXPECT_EQ(english_text(e.problems()[1].where), "r.toml:5:10");
    EXPECT_EQ(english_text(e.problems()[2].where), "r.toml:7:8");
    EXPECT_EQ(std::string(e.what()), english_text(e.problems()[0].message()) + " (and 2 more)");
  }
}

TEST(ParseRubric, MeasuresOfWhatTheExamDoesNotHaveAreNamedWithTheirPlace) {
  const std::string text = testing::scenario_text("[[zones.target]]\nshape = \"ball\"\nat_mm = [0, 0, 0]\nradius_mm = 1\n");
  const Scenario s = parse_scenario(text, "s.toml");
  const Tooth tooth = testing::dentin_block(2, 2, 0.1);
  std::string rubric = "rule = \"compensatory\"\npass_percent = 60\n";
  const std::vector<std::string> absent{"touched_pulpa_mm3", "protected_mm3", "overhang_mm3", "canals_covered_percent", "force_over_limit_s"};
  std::vector<std::string> all = absent;
  for (const char* there : {"container_mm3", "leeway_sides_mm3", "perforated", "touched_dentin_mm3", "dice"}) all.emplace_back(there);
  for (const auto& metric : all) rubric += "[[criteria]]\nid = \"" + metric + "\"\nmetric = \"" + metric + "\"\nfull = 0\nzero = 1\npoints = 1\n";
  const auto found = not_in_this_exam(parse_rubric(rubric, "r.toml"), s, tooth);
  ASSERT_EQ(found.size(), absent.size());
  for (std::size_t i = 0; i < absent.size(); ++i) {
    EXPECT_NE(english_text(found[i].what).find("'" + absent[i] + "'"), std::string::npos) << english_text(found[i].message());
    EXPECT_EQ(english_text(found[i].where), "r.toml:" + std::to_string(5 + 6 * i) + ":10");
  }
  EXPECT_TRUE(not_in_this_exam(s.rubric, s, tooth).empty());
}

}  // namespace
}  // namespace cavum::scenarios
