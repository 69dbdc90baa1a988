// Scores that go to a learning platform: released ones alone, once each, corrected and taken back
// as the ledger says.
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "grading/records/decision.h"
#include "grading/records/passback.h"
#include "grading/records/regrade.h"
#include "grading/records/release.h"
#include "tests/ui/office/lti/platform.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using namespace std::chrono_literals;
using nlohmann::json;

/// Two exams are filed, of 4711 and 4712.
class Grades : public ::testing::Test {
 protected:
  void SetUp() override {
    LtiPlatforms(opened_.home() + "/platforms.json").set(platform_in(platform_.set_up()));
    ASSERT_EQ(opened_.issue(officer_, "4711\n4712\n").status, 200);
    auto station = opened_.station();
    for (const json& ticket : station.tickets()) {
      const Bytes image = read_file(opened_.school().sit(ticket["text"]));
      station.hand_in(image);
      const json filed = Opened::outcome(station, to_hex(sha256(image)));
      ASSERT_EQ(filed["state"], "filed") << filed;
      auto ledger = opened_.school().ledger();
      const auto& session = ledger.registry().sessions.back();
      const std::string number = records::Identities(opened_.school().places().identities())
                                     .of_pseudonym(session.candidate)
                                     ->id;
      sessions_[number] = session.seq;
      hashes_[number] = session.file_sha256;
      result_ = *session.result;
    }
  }
  void TearDown() override {
    EXPECT_EQ(platform_.control()["violations"], json::array())
        << "what this office sent and a standard refuses";
  }

  void release(const std::vector<std::string>& numbers) {
    records::ReleaseCommand wish;
    wish.undecided = true;
    for (const auto& n : numbers) wish.sessions.push_back(sessions_.at(n));
    auto ledger = opened_.school().ledger();
    ASSERT_EQ(records::release_results(ledger, wish).results.size(), numbers.size());
  }
  /// Once nothing waits any more, or something keeps it; `again`: an officer has pressed the
  /// button.
  json settled(bool again = true) {
    if (again) {
      EXPECT_EQ(officer_.post("/api/lti/send", {}).status, 200);
    }
    std::this_thread::sleep_for(300ms);
    json progress;
    for (int i = 0; i < 150; ++i) {
      progress = officer_.get("/api/lti").json()["progress"];
      if (!progress.empty() &&
          (progress[0]["waiting"] == 0 || !text_in(progress[0], "trouble").empty()))
        break;
      std::this_thread::sleep_for(100ms);
    }
    return progress.empty() ? json::object() : progress[0];
  }
  [[nodiscard]] std::vector<records::PassbackEntry> entries() const {
    return records::read_registry(opened_.content()).passbacks;
  }
  Heard come(const std::string& who) { return Browser{opened_.port(), &platform_}.launch(who); }

  Opened opened_;
  Platform platform_{opened_.address()};
  Visitor officer_ = opened_.signed_in(Role::officer);
  std::map<std::string, std::uint64_t> sessions_;
  std::map<std::string, std::string> hashes_;
  json result_;
};

TEST_F(Grades, AreSentOnceWhenReleasedAndCorrectedAndTakenBack) {
  ASSERT_EQ(come("Learner:4711").status, 303);
  ASSERT_EQ(come("Instructor:anna").status, 303);
  EXPECT_EQ(settled()["waiting"], 0);
  EXPECT_EQ(platform_.control()["posts"], json::array()) << "nothing is released";
  release({"4711", "4712"});
  json progress = settled();
  EXPECT_EQ(progress["sent"], 1) << progress;
  EXPECT_EQ(progress["unknown"], 1) << "4712 has not come yet";
  json state = platform_.control();
  ASSERT_EQ(state["posts"].size(), 1U) << state;
  EXPECT_EQ(state["items"].size(), 1U);
  EXPECT_EQ(state["items"][0]["resourceId"], "block_cavity");
  EXPECT_NEAR(state["results"]["u-4711"]["score"].get<double>(),
              result_["score"]["points"].get<double>(), 1e-6);
  ASSERT_EQ(entries().size(), 1U);
  EXPECT_EQ(entries()[0].session, sessions_["4711"]);
  EXPECT_TRUE(entries()[0].accepted());
  EXPECT_EQ(opened_.content().entries.back().text.find("u-4711"), std::string::npos)
      << "no person in the ledger";

  ASSERT_EQ(come("Learner:4712").status, 303);
  settled();
  settled();
  EXPECT_EQ(platform_.control()["posts"].size(), 2U) << "once each";

  auto ledger = opened_.school().ledger();
  json better = result_;
  better["score"]["points"] = 71.5, better["verdict"] = "pass";
  records::enter_regrade(ledger, sessions_["4711"], better, {}, "an appeal");
  settled();
  EXPECT_EQ(platform_.control()["posts"].size(), 2U) << "a new mark waits for its release";
  release({"4711"});
  settled();
  state = platform_.control();
  ASSERT_EQ(state["posts"].size(), 3U);
  const json& corrected = state["posts"][2];
  EXPECT_EQ(corrected["userId"], "u-4711");
  EXPECT_EQ(corrected["scoreGiven"], 71.5);

  auto now = opened_.school().ledger();
  records::retract_results(now, {sessions_["4711"]}, "wrong tooth");
  settled();
  state = platform_.control();
  ASSERT_EQ(state["posts"].size(), 4U);
  EXPECT_FALSE(state["posts"][3].contains("scoreGiven"));
  EXPECT_FALSE(state["posts"][3].contains("comment"));
  EXPECT_EQ(state["results"]["u-4711"]["score"], json());
  EXPECT_EQ(state["results"]["u-4712"]["score"].is_number(), true);
  EXPECT_EQ(entries().back().result, 0U);
  settled();
  EXPECT_EQ(platform_.control()["posts"].size(), 4U);
  EXPECT_TRUE(records::read_registry(opened_.content()).findings.empty());
}

TEST_F(Grades, AReviewIsNeverSentAsAMark) {
  ASSERT_EQ(come("Learner:4711").status, 303);
  auto ledger = opened_.school().ledger();
  json review = result_;
  review["verdict"] = "review";
  records::enter_regrade(ledger, sessions_["4711"], review, {}, "left to a person");
  release({"4711"});
  settled();
  json state = platform_.control();
  EXPECT_EQ(state["posts"].size(), 0U) << "no column is made for it: " << state;
  platform_.control({{"coupled", true}});
  ASSERT_EQ(come("Learner:4711").status, 303);
  settled();
  state = platform_.control();
  ASSERT_EQ(state["posts"].size(), 1U) << state;
  EXPECT_EQ(state["posts"][0]["gradingProgress"], "PendingManual");
  EXPECT_FALSE(state["posts"][0].contains("scoreGiven"));
  auto now = opened_.school().ledger();
  records::enter_decision(now, sessions_["4711"],
                          {grading::Verdict::pass, "Dr Stein", "the wall is thick enough"});
  release({"4711"});
  settled();
  state = platform_.control();
  ASSERT_EQ(state["posts"].size(), 2U);
  EXPECT_EQ(state["posts"][1]["gradingProgress"], "FullyGraded");
  EXPECT_TRUE(state["posts"][1]["scoreGiven"].is_number());
}

TEST_F(Grades, GoOutLaterWhereThePlatformIsDownAndNoneTwice) {
  ASSERT_EQ(come("Learner:4711").status, 303);
  ASSERT_EQ(come("Learner:4712").status, 303);
  for (const char* how : {"silent", "503"}) {
    platform_.control({{"down", how}});
    if (std::string(how) == "silent") release({"4711", "4712"});
    const json progress = settled();
    EXPECT_EQ(progress["waiting"], 2) << how << progress;
    EXPECT_NE(progress["trouble"], "") << how;
    EXPECT_TRUE(entries().empty()) << "nothing was answered";
  }
  opened_.close();  // what is due is known from the ledger alone
  opened_.open();
  officer_ = opened_.signed_in(Role::officer);
  platform_.control({{"down", ""}});
  const json progress = settled();
  EXPECT_EQ(progress["sent"], 2) << progress;
  EXPECT_EQ(progress["trouble"], "");
  settled();
  EXPECT_EQ(platform_.control()["posts"].size(), 2U);
  EXPECT_EQ(entries().size(), 2U);
}

TEST_F(Grades, ATokenThatEndedIsAskedForAgainAndARefusalStays) {
  platform_.control({{"roster", {"u-4711"}}});
  ASSERT_EQ(come("Learner:4711").status, 303);
  ASSERT_EQ(come("Learner:4712").status, 303);
  release({"4711"});
  settled();
  platform_.control({{"tokens", "over"}});
  release({"4712"});
  const json progress = settled(false);
  EXPECT_EQ(progress["sent"], 1) << progress;
  EXPECT_EQ(progress["refused"], 1) << progress;
  ASSERT_EQ(entries().size(), 2U);
  EXPECT_EQ(entries()[1].status, 404);
  EXPECT_NE(entries()[1].answer.find("nobody of that name"), std::string::npos);
  platform_.control({{"roster", {"u-4711", "u-4712"}}});
  std::this_thread::sleep_for(6s);
  EXPECT_EQ(entries().size(), 2U) << "it is not sent again by itself";
  EXPECT_EQ(settled()["sent"], 2);
}

TEST_F(Grades, FindTheirColumnOnALaterPageAndOnlyWhereThePlatformIs) {
  platform_.control({{"page", 1}});
  ASSERT_EQ(come("Learner:4711").status, 303);
  release({"4711"});
  settled();
  ASSERT_EQ(platform_.control()["items"].size(), 1U);
  std::filesystem::remove(opened_.home() + "/" + opened_.id() +
                          "/courses.json");  // as another office would come
  platform_.control({{"lineitems", "https://169.254.169.254/course/7/lineitems"}});
  ASSERT_EQ(come("Learner:4711").status, 303) << "he may look";
  EXPECT_NE(
      settled()["trouble"].get<std::string>().find("https://169.254.169.254/course/7/lineitems"),
      std::string::npos)
      << "and no score goes elsewhere";
  platform_.control({{"lineitems", ""}});
  ASSERT_EQ(come("Learner:4711").status, 303);
  EXPECT_EQ(settled()["sent"], 1);
  EXPECT_EQ(platform_.control()["items"].size(), 1U) << "found, not made again";
}

TEST_F(Grades, ALearnerSeesHisOwnReleasedResultAndNoneBesides) {
  Browser b{opened_.port(), &platform_};
  ASSERT_EQ(b.launch("Learner:4711").status, 303);
  EXPECT_EQ(b.ask("GET", "/lti/report/" + hashes_["4711"]).status, 400) << "not released";
  release({"4711", "4712"});
  const Heard page = b.ask("GET", "/lti/result");
  EXPECT_NE(page.body.find("/lti/report/" + hashes_["4711"]), std::string::npos) << page.body;
  EXPECT_EQ(page.body.find(hashes_["4712"]), std::string::npos);
  EXPECT_EQ(page.body.find("<script"), std::string::npos);
  const Heard own = b.ask("GET", "/lti/report/" + hashes_["4711"]);
  EXPECT_EQ(own.status, 200);
  EXPECT_NE(own.body.find("student"), std::string::npos) << "the student's report: " << own.body;
  EXPECT_EQ(b.ask("GET", "/lti/report/" + hashes_["4712"]).status, 400) << "another's";
  for (const char* path : {"/api/results", "/api/gradebook.csv", "/api/me", "/api/criteria.csv"})
    EXPECT_EQ(b.ask("GET", path).status, 401) << path;
  EXPECT_EQ(b.ask("GET", "/api/report/" + hashes_["4711"]).status, 401)
      << "the instructor's report";
  platform_.control({{"exam", "another_exam"}});
  Browser elsewhere{opened_.port(), &platform_};
  ASSERT_EQ(elsewhere.launch("Learner:4711").status, 303);
  EXPECT_EQ(elsewhere.ask("GET", "/lti/result").body.find("/lti/report/"), std::string::npos)
      << "the link is another exam's";
  Browser nobody{opened_.port(), &platform_};
  ASSERT_EQ(nobody.launch("Learner:").status, 303);
  EXPECT_EQ(nobody.ask("GET", "/lti/result").body.find("/lti/report/"), std::string::npos)
      << "the platform does not tell who comes";
  auto ledger = opened_.school().ledger();
  records::retract_results(ledger, {sessions_["4711"]}, "wrong tooth");
  EXPECT_EQ(b.ask("GET", "/lti/report/" + hashes_["4711"]).status, 400) << "taken back";
  EXPECT_EQ(b.ask("GET", "/lti/result").body.find(hashes_["4711"]), std::string::npos);
}

}  // namespace
}  // namespace cavum::office
