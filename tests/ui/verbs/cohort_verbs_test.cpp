// A simulated class by the commands of the README: it sits, is filed, and its figures and pictures are those of its sessions.
#include <fmt/core.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/ui/program.h"

namespace cavum::ui {
namespace {

using nlohmann::json;

class CohortVerbs : public testing_ui::Program {};

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST_F(CohortVerbs, AClassIsReportedInWordsFiguresAndPictures) {
  ASSERT_EQ(run("ledger init " + path("L") + " --school Dentistry").exit_code, 0);
  const std::string task = std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";
  const auto sat = run("cohort simulate " + task + " --ledger " + path("L") + " --sessions " + path("S") + " --n 5 --json");
  ASSERT_EQ(sat.exit_code, 0) << sat.err;
  EXPECT_EQ(json::parse(sat.out)["filed"], 5);

  const auto told = run("cohort report " + path("L") + " --exam block_cavity --out " + path("class.html"));
  ASSERT_EQ(told.exit_code, 0) << told.err;
  const auto figures = json::parse(run("cohort report " + path("L") + " --exam block_cavity --json").out);
  // the figures again, from the sessions themselves
  double points = 0, floor_mm = 0;
  int passed = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path("S"))) {
    const auto graded = json::parse(run("grade " + entry.path().string() + " --json").out);
    points += graded["score"]["points"].get<double>() / 5;
    floor_mm += graded["walls"]["floor"]["p95_mm"].get<double>() / 5;
    passed += graded["verdict"] == "pass" ? 1 : 0;
  }
  EXPECT_EQ(figures["n"], 5);
  EXPECT_NEAR(figures["points"]["mean"].get<double>(), points, 1e-9);
  EXPECT_EQ(figures["verdicts"]["pass"], passed);
  EXPECT_NEAR(figures["walls"]["floor"]["p95_mm"].get<double>(), floor_mm, 1e-9);
  EXPECT_NE(told.out.find("block_cavity: 5 candidates, 5 of them simulated"), std::string::npos) << told.out;
  for (const auto& criterion : figures["criteria"]) EXPECT_NE(told.out.find(criterion["id"].get<std::string>()), std::string::npos) << told.out;

  const std::string page = read_text_file(path("class.html"));
  EXPECT_NE(page.find("5 cavities laid over each other"), std::string::npos);
  EXPECT_GE(count(page, "<svg"), 6u) << "distribution, four pictures of the tooth and their key";
  EXPECT_EQ(count(page, "src='") + count(page, "src=\"") + count(page, "<link"), 0u) << "nothing from a network";
  EXPECT_EQ(page.find("simulated-1-"), std::string::npos) << "no number of the school";

  const auto nobody = run("cohort report " + path("L") + " --exam unknown");
  EXPECT_EQ(nobody.exit_code, 2);
  EXPECT_NE(nobody.err.find("was sat by nobody"), std::string::npos) << nobody.err;

  write_text_file(path("marks.csv"), "candidate,judge,points,rating\nsimulated-1-0001,x,3,2\nsimulated-1-0002,x,3,4\n");
  const auto beyond = run("cohort report " + path("L") + " --exam block_cavity --marks " + path("marks.csv") + " --borderline 5");
  EXPECT_EQ(beyond.exit_code, 2) << beyond.out;
  EXPECT_NE(beyond.err.find("--borderline 5: does not lie within the ratings"), std::string::npos) << beyond.err;
}

TEST_F(CohortVerbs, AFormThatGivesFewerPointsForTheSameWorkIsTooHard) {
  const std::string task = std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";
  const auto changed = [&](const std::string& name, const std::string& what, const std::string& by) {
    std::string text = read_text_file(task);
    for (const auto& [from, to] : {std::pair{std::string("block_cavity\""), name + "\""}, std::pair{what, by}})
      if (const auto at = text.find(from); at != std::string::npos) text.replace(at, from.size(), to);
    write_text_file(path(name + ".toml"), text);
    return path(name + ".toml");
  };
  // all else equal: nobody leaves so little of the target
  const std::string hard = changed("hard", "full = 90\nzero = 60", "full = 100\nzero = 99.9");
  const std::string forms = task + " " + hard;
  const auto told = run("cohort difficulty " + forms + " --candidates 10 --out " + path("marks.csv") + " --json");
  ASSERT_EQ(told.exit_code, 1) << told.err << told.out;
  const auto j = json::parse(told.out);
  ASSERT_EQ(j["forms"].size(), 2u);
  EXPECT_EQ(j["limit_percent"], 2) << "the borderline band of both";
  EXPECT_EQ(j["forms"][1]["verdict"], "too hard");
  EXPECT_EQ(j["forms"][0]["verdict"], "too easy");

  std::istringstream rows(read_text_file(path("marks.csv")));
  std::string line;
  ASSERT_TRUE(std::getline(rows, line));
  EXPECT_EQ(line, "student,seed,block_cavity,hard");
  double own = 0, other = 0;
  int n = 0;
  for (; std::getline(rows, line); ++n) {
    const auto last = line.rfind(','), before = line.rfind(',', last - 1);
    own += std::stod(line.substr(before + 1)), other += std::stod(line.substr(last + 1));
    EXPECT_EQ(line.rfind(fmt::format("student-{},", 5 + 10 * n), 0), 0u) << line;
  }
  EXPECT_EQ(n, 10);
  EXPECT_NEAR(j["forms"][0]["mean_percent"].get<double>(), own / n, 1e-3);
  EXPECT_NEAR(j["forms"][1]["constant_percent"].get<double>(), (own - other) / n / 2, 1e-3) << "half of what lies between two forms";

  const auto one = run("cohort difficulty " + task);
  EXPECT_EQ(one.exit_code, 2);
  EXPECT_NE(one.err.find("needs two forms at least"), std::string::npos) << one.err;
  const auto twice = run("cohort difficulty " + task + " " + task + " --candidates 10");
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_NE(twice.err.find("is that of another form"), std::string::npos) << twice.err;
  const auto marks = run("cohort difficulty " + task + " " + changed("other", "pass_percent = 60", "pass_percent = 61") + " --candidates 10");
  EXPECT_EQ(marks.exit_code, 2);
  EXPECT_NE(marks.err.find("forms of one exam have one pass mark"), std::string::npos) << marks.err;
}

}  // namespace
}  // namespace cavum::ui
