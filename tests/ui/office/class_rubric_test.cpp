// A new rubric over a whole class at the office: what is shown before it counts, who lets it count
// and how, and what a restart or a kill leaves.
#include <random>

#include "grading/marking/grade.h"
#include "grading/records/release.h"
#include "tests/grading/records/short_exam.h"
#include "tests/ui/office/opened.h"
#include "tests/ui/office/served.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using nlohmann::json;

const std::string k_new_rubric =
    "[rubric]\nrule = \"compensatory\"\npass_percent = 10\n[[rubric.criteria]]\nid = \"removed\"\nmetric = \"target_removed_percent\"\nfull = 50\n"
    "zero = 0\npoints = 10\n";
constexpr char k_eva[] = "Eva Stein", k_exam[] = "block_cavity";

/// A school with some short exams that are filed.
void file_some(const School& school, int exams, const std::string& whose = "c") {
  records::Ledger ledger = school.ledger();
  for (int i = 0; i < exams; ++i) {
    const std::string path = school.file(whose + std::to_string(i) + ".cavum");
    sit_shortly(k_scenario, path, school.ticket(whose + std::to_string(i)));
    ASSERT_TRUE(records::file_session(ledger, path).seq);
  }
}

json waited(const Visitor& v) {
  for (int i = 0; i < 1200; ++i) {
    json state = v.get("/api/regrade").json();
    if (state["state"] != "marking") return state;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return {{"state", "waited a minute"}};
}

class ClassRubric : public ::testing::Test {
 protected:
  void SetUp() override {
    file_some(opened_.school(), 2);
    opened_.accounts().set(k_eva, Role::examiner, k_password, true);
    ASSERT_EQ(eva_.sign_in(k_eva, k_password).status, 200);
  }
  json begin(const std::string& rubric = k_new_rubric) {
    return eva_.post("/api/regrade/begin", {{"exam", k_exam}, {"rubric", rubric}}).json();
  }
  Heard count(const json& begun, int steps_on = 0) {
    return eva_.post("/api/regrade/count", {{"id", begun["id"]},
                                            {"reason", "question 3 was misprinted"},
                                            {"code", opened_.code_of(k_eva, steps_on)}});
  }
  std::size_t entries() const { return opened_.content().entries.size(); }

  Opened opened_;
  Visitor eva_{opened_.port()}, examiner_ = opened_.signed_in(Role::examiner),
                                officer_ = opened_.signed_in(Role::officer);
};

TEST_F(ClassRubric, ShowsWhoWouldChangeAndCountsAllAtOnce) {
  const std::size_t before = entries();
  const json begun = begin();
  const json state = waited(eva_);
  ASSERT_EQ(state["state"], "ready") << state;
  ASSERT_EQ(state["sessions"].size(), 2u);
  EXPECT_EQ(entries(), before) << "nothing counts yet";
  const auto registry = records::read_registry(opened_.content());
  for (std::size_t i = 0; i < 2; ++i) {  // marked here by the rubric itself, without the office
    const json& row = state["sessions"][i];
    grading::ExamContexts grounds;
    const auto graded = grading::load_for_grading(
        SessionReader(opened_.school().places().session(registry.sessions[i].file_sha256)),
        grounds);
    grading::use_rubric(*graded, scenarios::parse_rubric(k_new_rubric, "rubric"));
    const json wanted =
        json::parse(grading::to_json(grading::grade(graded->input(), graded->rubric)).dump());
    EXPECT_EQ(row["candidate"], registry.sessions[i].candidate);
    EXPECT_EQ(row["points"], wanted["score"]["points"]);
    EXPECT_EQ(row["max"], 10);
    EXPECT_EQ(row["verdict"], wanted["verdict"]);
    EXPECT_EQ(row["points_before"], registry.sessions[i].result->at("score").at("points"));
    EXPECT_FALSE(row.contains("name"));
  }
  ASSERT_EQ(count(begun).json()["counted"], 2) << "all in one";
  const auto content = opened_.content();
  ASSERT_EQ(content.entries.size(), before + 2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NE(content.entries[before + i].as<records::RegradeEntry>(), nullptr);
    EXPECT_EQ(content.entries[before + i].by.account, k_eva);
    EXPECT_EQ(content.entries[before + i].by.reason, "question 3 was misprinted");
  }
  EXPECT_EQ(eva_.get("/api/regrade").json()["first_entry"], before);
  EXPECT_EQ(records::read_registry(content).sessions[0].result->at("score")["points"],
            state["sessions"][0]["points"]);
  EXPECT_TRUE(records::check_ledger(opened_.school().places(), true).findings.empty())
      << "made again from what the ledger keeps";
  EXPECT_EQ(count(begun, 1).status, 400) << "once";
}

TEST_F(ClassRubric, WhoSitsAfterwardsIsNotReleasedByTheOldRubricUnseen) {
  const json begun = begin();
  ASSERT_EQ(waited(eva_)["state"], "ready");
  ASSERT_EQ(count(begun).json()["counted"], 2);
  file_some(opened_.school(), 1, "late");
  const records::Release all = records::select_results(records::read_registry(opened_.content()),
                                                       {.all = true, .undecided = true});
  EXPECT_EQ(all.results.size(), 2u);
  EXPECT_EQ(all.withheld, 1u);
  const auto late = [&] {
    return opened_.signed_in(Role::officer)
        .get("/api/results")
        .json()["results"][2]["state"]
        .get<std::string>();
  };
  EXPECT_EQ(late(), "marked otherwise");
  const json again = begin();
  ASSERT_EQ(waited(eva_)["state"], "ready");
  ASSERT_EQ(count(again, 1).json()["counted"], 1) << "the others are marked by it already";
  EXPECT_NE(late(), "marked otherwise");
}

TEST_F(ClassRubric, AnotherPassMarkAloneGivesNobodyOtherPoints) {
  const std::string scenario = read_text_file(k_scenario);
  std::string own = scenario.substr(scenario.find("[rubric]"));
  own.replace(own.find("pass_percent = 60"), 17, "pass_percent = 55");
  static_cast<void>(begin(own));
  const json state = waited(eva_);
  ASSERT_EQ(state["state"], "ready") << state;
  for (const json& row : state["sessions"]) {
    EXPECT_EQ(row["points"], row["points_before"]);
    EXPECT_EQ(row["other_points"], false);
  }
}

TEST_F(ClassRubric, CountsOnlyForWhoLookedAtItWithReasonAndCode) {
  EXPECT_EQ(
      officer_.post("/api/regrade/begin", {{"exam", k_exam}, {"rubric", k_new_rubric}}).status,
      403);
  const std::size_t before = entries();
  const json begun = begin();
  ASSERT_EQ(waited(eva_)["state"], "ready");
  const auto count_as = [&](const Visitor& v, const json& asked) {
    json whole = {{"id", begun["id"]}, {"reason", "x"}, {"code", opened_.code_of(k_eva)}};
    whole.update(asked);
    return v.post("/api/regrade/count", whole).status;
  };
  EXPECT_EQ(count_as(officer_, json::object()), 403);
  EXPECT_EQ(count_as(examiner_, json::object()), 400) << "looked at by another one";
  EXPECT_EQ(count_as(eva_, {{"reason", ""}}), 400);
  EXPECT_EQ(count_as(eva_, {{"code", "000000"}}), 400);
  EXPECT_EQ(count_as(eva_, {{"id", "0123456789abcdef"}}), 400);
  EXPECT_EQ(examiner_.post("/api/regrade/drop", {{"id", begun["id"]}}).status, 400)
      << "of another one";
  EXPECT_EQ(
      examiner_.post("/api/regrade/begin", {{"exam", k_exam}, {"rubric", k_new_rubric}}).status,
      400)
      << "one at a time";
  EXPECT_EQ(entries(), before);
  EXPECT_EQ(eva_.post("/api/regrade/drop", {{"id", begun["id"]}}).status, 200);
  EXPECT_EQ(count(begun).status, 400) << "it was dropped";
  EXPECT_EQ(entries(), before);
  // an examiner without a second factor looks, and lets nothing count
  const json plain =
      examiner_.post("/api/regrade/begin", {{"exam", k_exam}, {"rubric", k_new_rubric}}).json();
  ASSERT_EQ(waited(examiner_)["state"], "ready");
  EXPECT_EQ(
      examiner_
          .post("/api/regrade/count", {{"id", plain["id"]}, {"reason", "x"}, {"code", "000000"}})
          .status,
      400);
  EXPECT_EQ(entries(), before);
}

TEST_F(ClassRubric, IsRefusedWhenTheClassIsAnotherByThen) {
  const json begun = begin();
  ASSERT_EQ(waited(eva_)["state"], "ready");
  {
    records::Ledger ledger = opened_.school().ledger();
    const std::string path = opened_.school().file("late.cavum");
    sit_shortly(k_scenario, path, opened_.school().ticket("late"));
    ASSERT_TRUE(records::file_session(ledger, path).seq);
  }
  const std::size_t before = entries();
  EXPECT_EQ(count(begun).status, 400) << "nobody has seen what becomes of the third";
  EXPECT_EQ(entries(), before);
}

TEST_F(ClassRubric, OfNoUseIsRefusedOrFailsWithWordsAndEntersNothing) {
  const std::size_t before = entries();
  for (
      const std::string& bad :
      {std::string(), std::string("[rubric\n"), std::string(300'000, '#'),
       "a" + std::string(20'000, '.') + "b = 1",
       k_new_rubric +
           "[[rubric.criteria]]\nid = \"x\"\nmetric = \"no such measure\"\nfull = 1\nzero = 0\npoints = 1\n"})
    EXPECT_EQ(eva_.post("/api/regrade/begin", {{"exam", k_exam}, {"rubric", bad}}).status, 400)
        << bad.substr(0, 40);
  EXPECT_EQ(
      eva_.post("/api/regrade/begin", {{"exam", "no such exam"}, {"rubric", k_new_rubric}}).status,
      400);
  EXPECT_EQ(
      eva_.post("/api/regrade/begin", {{"exam", k_exam}, {"rubric", std::string(600'000, '#')}})
          .status,
      413);
  EXPECT_EQ(eva_.get("/api/regrade").json()["state"], "none");
  EXPECT_EQ(entries(), before);
}

TEST_F(ClassRubric, SaysAfterARestartWhetherItCounts) {
  static_cast<void>(begin());
  ASSERT_EQ(waited(eva_)["state"], "ready");
  opened_.close();
  opened_.open();
  eva_.sign_in(k_eva, k_password);
  EXPECT_EQ(eva_.get("/api/regrade").json()["state"], "lost");
  const json again = begin();
  ASSERT_EQ(waited(eva_)["state"], "ready");
  ASSERT_EQ(count(again).json()["counted"], 2);
  opened_.close();
  opened_.open();
  eva_.sign_in(k_eva, k_password);
  const json state = eva_.get("/api/regrade").json();
  EXPECT_EQ(state["state"], "counted");
  EXPECT_EQ(state["counted"], 2);
  EXPECT_EQ(state["first_entry"], entries() - 2);
}

TEST(KilledClassRubric, IsDoneOrNotBegunAndTheOfficeSaysWhich) {
  constexpr int k_sessions = 6, k_kills = 6;
  const School fresh;
  file_some(fresh, k_sessions);
  const std::uint64_t seed = test::drawn_seed("when the server is killed while a rubric counts");
  std::mt19937_64 random(seed);
  for (int i = 0; i < k_kills; ++i) {
    const School school(fresh);
    Accounts accounts(station_path("office") + "/accounts.json");
    const Account eva = accounts.set(k_eva, Role::examiner, k_password, true);
    const std::size_t before = records::read_ledger(school.places()).entries.size();
    {
      Served served(school);
      Visitor v{served.port()};
      ASSERT_EQ(v.sign_in(k_eva, k_password).status, 200);
      const json begun =
          v.post("/api/regrade/begin", {{"exam", k_exam}, {"rubric", k_new_rubric}}).json();
      ASSERT_EQ(waited(v)["state"], "ready");
      const auto step =
          static_cast<std::uint64_t>(read_clocks().utc_ns / 1'000'000'000 / k_code_step_s);
      std::thread counting([&, code = one_time_code(*from_base32(eva.code_secret), step)] {
        static_cast<void>(
            v.post("/api/regrade/count", {{"id", begun["id"]}, {"reason", "x"}, {"code", code}}));
      });
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 60'000));
      served.kill();
      counting.join();
    }
    const auto content = records::read_ledger(school.places());
    EXPECT_TRUE(content.findings.empty()) << "seed " << seed;
    const std::size_t added = content.entries.size() - before;
    EXPECT_TRUE(added == 0 || added == k_sessions)
        << added << " of " << k_sessions << ", seed " << seed;
    const Served served(school);
    Visitor v{served.port()};
    ASSERT_EQ(v.sign_in(k_eva, k_password).status, 200);
    EXPECT_EQ(v.get("/api/regrade").json()["state"], added == 0 ? "lost" : "counted")
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace cavum::office
