// A simulated class by the commands of the README: it sits, is filed, and its figures and pictures
// are those of its sessions.
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
  const auto sat = run("cohort simulate " + task + " --ledger " + path("L") + " --sessions " +
                       path("S") + " --n 5 --json");
  ASSERT_EQ(sat.exit_code, 0) << sat.err;
  EXPECT_EQ(json::parse(sat.out)["filed"], 5);

  const auto told =
      run("cohort report " + path("L") + " --exam block_cavity --out " + path("class.html"));
  ASSERT_EQ(told.exit_code, 0) << told.err;
  const auto figures =
      json::parse(run("cohort report " + path("L") + " --exam block_cavity --json").out);
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
  EXPECT_EQ(figures["simulated"], 5);
  for (const auto& criterion : figures["criteria"])
    EXPECT_NE(told.out.find(criterion["id"].get<std::string>()), std::string::npos) << told.out;

  const std::string page = read_text_file(path("class.html"));
  EXPECT_GE(count(page, "<svg"), 6u) << "distribution, four pictures of the tooth and their key";
  EXPECT_EQ(count(page, "src='") + count(page, "src=\"") + count(page, "<link"), 0u)
      << "nothing from a network";
  EXPECT_EQ(page.find("simulated-1-"), std::string::npos) << "no number of the school";

  expect_refused("cohort report " + path("L") + " --exam unknown", {"unknown"});

  write_text_file(
      path("marks.csv"),
      "candidate,judge,points,rating\nsimulated-1-0001,x,3,2\nsimulated-1-0002,x,3,4\n");
  expect_refused("cohort report " + path("L") + " --exam block_cavity --marks " +
                     path("marks.csv") + " --borderline 5",
                 {"--borderline 5"});
}

TEST_F(CohortVerbs, ACircuitsComponentsAreThoseOfTheAnalysisOfVariance) {
  ASSERT_EQ(run("ledger init " + path("L") + " --school Dentistry").exit_code, 0);
  const std::string task = std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";
  std::string other = read_text_file(task);
  for (const auto& [from, to] : {std::pair{"block_cavity\"", "harder\""},
                                 std::pair{"full = 90\nzero = 60", "full = 100\nzero = 80"}})
    other.replace(other.find(from), std::string(from).size(), to);
  write_text_file(path("harder.toml"), other);
  for (const std::string& sat : {task, path("harder.toml")}) {
    const auto r = run("cohort simulate " + sat + " --ledger " + path("L") + " --sessions " +
                       path("S_" + std::to_string(sat.size())) + " --n 4");
    ASSERT_EQ(r.exit_code, 0) << r.err;
  }
  const auto told = run("cohort circuit " + path("L") + " --exams block_cavity,harder --json");
  ASSERT_EQ(told.exit_code, 0) << told.err;
  const auto j = json::parse(told.out);
  ASSERT_EQ(j["roster"].size(), 4u);
  // by hand: candidates by exams, one mark each
  double all = 0, rows = 0, columns = 0, squares = 0, sums[2] = {0, 0};
  for (const auto& row : j["roster"]) {
    const double a = row["exams"]["block_cavity"]["percent"], b = row["exams"]["harder"]["percent"];
    EXPECT_NEAR(row["raw_percent"].get<double>(), (a + b) / 2, 1e-9);
    all += a + b, squares += a * a + b * b, rows += (a + b) * (a + b) / 2, sums[0] += a,
        sums[1] += b;
  }
  const double middle = all * all / 8;
  for (const double sum : sums) columns += sum * sum / 4;
  const double ms_row = (rows - middle) / 3, ms_column = columns - middle,
               ms_rest = (squares - rows - columns + middle) / 3;
  const double by_hand[] = {(ms_row - ms_rest) / 2, (ms_column - ms_rest) / 4, ms_rest};
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(j["program"]["components"][k]["variance"].get<double>(), by_hand[k], 1e-6) << k;
  EXPECT_GT(j["stations"]["conditions"].size(), 0u);
  EXPECT_TRUE(j["people"]["as_sat"].is_null());
  EXPECT_TRUE(j["people"]["why_not"].is_string());

  // Two judges of both exams, of whom one takes ten points off.
  const auto marks = [&](const std::string& exam) {
    std::string text = "candidate,judge,points\n";
    for (const auto& row : j["roster"]) {
      const double percent = row["exams"][exam]["percent"].get<double>();
      for (const double off : {0.0, 10.0})
        text += fmt::format("{},{},{:.4f}\n", row["candidate"].get<std::string>(),
                            off > 0 ? "severe" : "mild", 10 + 0.8 * percent - off);
    }
    write_text_file(path(exam + ".csv"), text);
    return " --marks " + exam + "=" + path(exam + ".csv");
  };
  const auto with = run("cohort circuit " + path("L") + " --exams block_cavity,harder" +
                        marks("block_cavity") + marks("harder") + " --json");
  ASSERT_EQ(with.exit_code, 0) << with.err;
  const auto people = json::parse(with.out);
  ASSERT_EQ(people["judges"]["conditions"].size(), 2u);
  for (const auto& judge : people["judges"]["conditions"])
    EXPECT_NEAR(judge["severity_percent"].get<double>(), judge["name"] == "severe" ? 5 : -5, 1e-6);
  EXPECT_EQ(people["people"]["components"].size(), 7u)
      << "candidates, exams, judges and what they do together";

  // Three of the four were marked by people: the mean's error is that of three.
  std::string some = "candidate,judge,points\n";
  for (int i = 0; i < 3; ++i)
    for (const char* judge : {"A", "B"})
      some += fmt::format("{},{},{}\n", j["roster"][i]["candidate"].get<std::string>(), judge,
                          70 + 5 * i + 4 * i * i);
  write_text_file(path("some_a.csv"), some);
  some.replace(some.rfind(",B,"), 3, ",B,1");  // the last one differs
  some.erase(some.size() - 2, 1);
  write_text_file(path("some_b.csv"), some);
  const auto three =
      json::parse(run("cohort circuit " + path("L") +
                      " --exams block_cavity,harder --marks block_cavity=" + path("some_a.csv") +
                      " --marks harder=" + path("some_b.csv") + " --json")
                      .out);
  ASSERT_TRUE(three["people"]["as_sat"].is_object()) << three["people"];
  EXPECT_EQ(three["people"]["as_sat"]["candidates"], 3);
  EXPECT_EQ(three["people"]["as_sat"]["conditions"], json({2.0, 2.0}));
  const double phi = three["people"]["as_sat"]["phi"],
               delta = std::pow(three["people"]["as_sat"]["relative_sem_percent"].get<double>(), 2),
               of_mark =
                   std::pow(three["people"]["as_sat"]["absolute_sem_percent"].get<double>(), 2),
               truth = phi / (1 - phi) * of_mark;
  const double away =
      three["people"]["mean_percent"].get<double>() - three["cut_percent"].get<double>();
  const double signal = away * away - ((truth + delta) / 3 + of_mark - delta);
  ASSERT_GT(signal, 0) << "else it counts as 0, and the number of candidates does not show";
  EXPECT_NEAR(three["people"]["at_cut"]["phi"].get<double>(),
              (truth + signal) / (truth + signal + of_mark), 1e-9);

  // One judge written in two ways.
  some.replace(some.find(",A,"), 3, ",a ,");
  write_text_file(path("some_b.csv"), some);
  for (const char* exam : {"block_cavity", "harder"})  // in one file, and in two
    expect_refused("cohort circuit " + path("L") + " --exams block_cavity,harder --marks " + exam +
                       "=" + path("some_b.csv"),
                   {"'a'"});

  // Marks all alike are no study; a mark of somebody who did not sit the exam is told by name.
  std::string alike = "candidate,judge,points\nnobody,A,50\n";
  for (const auto& row : j["roster"])
    for (const char* judge : {"A", "B"})
      alike += fmt::format("{},{},50\n", row["candidate"].get<std::string>(), judge);
  for (const char* name : {"a.csv", "b.csv"}) write_text_file(path(name), alike);
  const std::string of_alike =
      "cohort circuit " + path("L") +
      " --exams block_cavity,harder --marks block_cavity=" + path("a.csv") +
      " --marks harder=" + path("b.csv");
  const auto nothing = json::parse(run(of_alike + " --json").out);
  EXPECT_NE(nothing["people"]["why_not"], j["people"]["why_not"])
      << "for another reason than that there are none";
  EXPECT_TRUE(nothing["people"].at("as_sat").is_null());
  ASSERT_EQ(nothing["marks_left_out"].size(), 2u);
  EXPECT_EQ(nothing["marks_left_out"][0]["candidate"], "nobody");
  const std::string in_words = run(of_alike).out;
  for (const char* who : {"nobody (block_cavity)", "nobody (harder)"})
    EXPECT_NE(in_words.find(who), std::string::npos) << in_words;

  for (const auto& [line, error] :
       {std::pair{"--exams harder", ""}, std::pair{"--exams harder,harder", ""},
        std::pair{"--exams harder,unknown", "unknown"},
        std::pair{"--exams harder,block_cavity --marks other=x.csv", "other"}})
    expect_refused("cohort circuit " + path("L") + " " + line, {error});
}

TEST_F(CohortVerbs, AFormThatGivesFewerPointsForTheSameWorkIsTooHard) {
  const std::string task = std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";
  const auto changed = [&](const std::string& name, const std::string& what,
                           const std::string& by) {
    std::string text = read_text_file(task);
    for (const auto& [from, to] :
         {std::pair{std::string("block_cavity\""), name + "\""}, std::pair{what, by}})
      if (const auto at = text.find(from); at != std::string::npos)
        text.replace(at, from.size(), to);
    write_text_file(path(name + ".toml"), text);
    return path(name + ".toml");
  };
  // all else equal: nobody leaves so little of the target
  const std::string hard = changed("hard", "full = 90\nzero = 60", "full = 100\nzero = 99.9");
  const std::string forms = task + " " + hard;
  const auto told =
      run("cohort difficulty " + forms + " --candidates 10 --out " + path("marks.csv") + " --json");
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
  EXPECT_NEAR(j["forms"][1]["constant_percent"].get<double>(), (own - other) / n / 2, 1e-3)
      << "half of what lies between two forms";

  expect_refused("cohort difficulty " + task, {});
  expect_refused("cohort difficulty " + task + " " + task + " --candidates 10", {"block_cavity"});
  expect_refused("cohort difficulty " + task + " " +
                     changed("other", "pass_percent = 60", "pass_percent = 61") +
                     " --candidates 10",
                 {"60", "61"});
}

}  // namespace
}  // namespace cavum::ui
