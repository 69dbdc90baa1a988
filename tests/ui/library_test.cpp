// The tasks that ship: each is sound, leaves the expert time, is passed by him and failed by the
// careless candidate for the very reason that the scenario names. From the files in data/scenarios
// to the verdict, in one process.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "grading/marking/session_input.h"
#include "grading/result/result_json.h"
#include "scenarios/operators/simulated_exam.h"
#include "scenarios/review/check.h"
#include "tests/engine/support/basics.h"

namespace cavum::ui {
namespace {

namespace fs = std::filesystem;

const std::string k_folder = std::string(CAVUM_SOURCE_DIR) + "/data/scenarios";

/// For what a failed test prints.
std::string told(const grading::Result& r) {
  std::string all = std::string(grading::verdict_name(r.verdict)) + ", " +
                    std::to_string(r.points) + " points, " + finish_name(r.progress.finish) + "\n";
  for (const auto& reason : r.verdict_reasons) all += "  " + english_text(reason.message()) + "\n";
  for (const auto& c : r.criteria) all += "  " + c.id + ": " + english_text(c.reason()) + "\n";
  return all;
}

class Library : public ::testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] std::string file() const { return k_folder + "/" + GetParam() + ".toml"; }
  [[nodiscard]] std::unique_ptr<scenarios::ExamSetup> prepared() const {
    scenarios::ExamOptions options;
    options.candidate = "simulated";
    return scenarios::prepare_exam(file(), options);
  }
  /// Recorded and read back.
  [[nodiscard]] grading::Result taken_by(const std::string& who,
                                         const scenarios::ExamSetup& setup) const {
    const std::uint64_t seed =
        testing_basics::drawn_seed(("Library." + who + "." + GetParam()).c_str()) % 100000;
    scenarios::SimulatedCandidate candidate =
        scenarios::make_simulated_candidate(setup, who, seed, OmniModel{});
    const std::string session = folder_.file(who + "-" + std::to_string(seed) + ".cavum");
    const auto exam = scenarios::Exam::start(setup, session, candidate.start_mm());
    scenarios::run_exam(*exam, candidate);
    exam->recorder().flush();
    grading::ExamContexts grounds(setup);
    const auto graded =
        grading::load_for_grading(SessionReader(session), exam->tooth_now(), grounds);
    grading::GradeInput input = graded->input();
    input.again = nullptr;  // how much force a perforation took away is not asked here
    grading::Result r = grading::grade(input, graded->rubric);
    exam->close(grading::to_json(r).dump());
    return r;
  }
  testing_basics::Folder folder_;
};

TEST_P(Library, IsSoundWithoutAWarningAndTheExpertHasTwiceTheTime) {
  const std::string text = read_text_file(file());
  const scenarios::CheckedScenario checked = scenarios::check_whole(text, file());
  for (const auto& p : checked.problems) ADD_FAILURE() << english_text(p.message());
  ASSERT_TRUE(checked.expert.time_s);
  const scenarios::Scenario s = scenarios::parse_scenario(text, file());
  EXPECT_LT(2 * *checked.expert.time_s, s.time_limit_s);
  EXPECT_EQ(s.id, GetParam());
  double points = 0;
  for (const auto& c : s.rubric.criteria) points += c.points;
  EXPECT_DOUBLE_EQ(points, 100);
}

/// Two whole exams each.
class TakenTask : public Library {};

TEST_P(TakenTask, IsPassedByTheExpertAndFailedByTheCarelessForTheReasonItNames) {
  const auto setup = prepared();
  const grading::Result expert = taken_by("expert", *setup);
  EXPECT_EQ(expert.verdict, grading::Verdict::pass) << told(expert);
  EXPECT_GE(expert.points, 90) << told(expert);
  for (const auto& c : expert.criteria)
    EXPECT_DOUBLE_EQ(c.work_share, 1)
        << "who does it well is not credited with it: " << c.id << ", " << english_text(c.reason());
  EXPECT_EQ(expert.progress.finish, Finish::completed) << told(expert);

  const std::string reason = setup->scenario.careless.fails_by;
  ASSERT_FALSE(reason.empty()) << "a task that ships says what it is there to catch";
  const grading::Result careless = taken_by("careless", *setup);
  EXPECT_EQ(careless.verdict, grading::Verdict::fail) << told(careless);
  EXPECT_NE(careless.progress.finish, Finish::time) << "failed by a time-out instead";
  const auto c = std::find_if(careless.criteria.begin(), careless.criteria.end(),
                              [&](const auto& one) { return one.id == reason; });
  ASSERT_NE(c, careless.criteria.end());
  EXPECT_TRUE(c->critical_failed) << told(careless);
  EXPECT_DOUBLE_EQ(c->points, 0) << told(careless);
}

/// The criteria that fail whoever breaks into what is no aim, whatever else he has points for.
std::vector<const scenarios::CriterionSpec*> against_perforation(const scenarios::Scenario& s) {
  std::vector<const scenarios::CriterionSpec*> list;
  for (const auto& c : s.rubric.criteria)
    if (c.metric == "perforated" && c.critical_above && *c.critical_above < 1) list.push_back(&c);
  return list;
}

TEST_P(Library, AnyPerforationThatIsAFaultIsCritical) {
  const scenarios::Scenario s = scenarios::parse_scenario(read_text_file(file()), file());
  EXPECT_FALSE(s.perforation.faults.empty());
  EXPECT_FALSE(against_perforation(s).empty()) << "who perforates would pass";
}

INSTANTIATE_TEST_SUITE_P(Tasks, Library, ::testing::ValuesIn(testing_basics::toml_names(k_folder)),
                         [](const auto& test) { return test.param; });
INSTANTIATE_TEST_SUITE_P(Tasks, TakenTask,
                         ::testing::ValuesIn(testing_basics::some_of(
                             testing_basics::toml_names(k_folder), 3, "TakenTask")),
                         [](const auto& test) { return test.param; });

/// Where nobody would look for a pulp.
class BlockTask : public Library {};

TEST_P(BlockTask, WhoPerforatesFails) {
  const auto setup = prepared();
  const grading::Result r = taken_by("perforator", *setup);
  ASSERT_TRUE(r.perforation.fault.perforated) << told(r);
  EXPECT_EQ(r.verdict, grading::Verdict::fail) << told(r);
  for (const auto& c : r.criteria)
    EXPECT_TRUE(c.metric != "perforated" || c.critical_failed) << told(r);
}
INSTANTIATE_TEST_SUITE_P(Tasks, BlockTask, ::testing::Values("slot", "cross"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace cavum::ui
