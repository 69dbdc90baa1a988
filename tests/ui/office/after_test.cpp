// What becomes of results at the office: an appeal with its trail, a result that is taken back, and
// the report of an exam as a page of no site.
#include "engine/base/hash.h"
#include "grading/records/entry_text.h"
#include "grading/records/issue.h"
#include "grading/records/signed_note.h"
#include "tests/ui/office/opened.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using nlohmann::json;

/// An office with one exam that is filed.
class AfterTheExam : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(opened_.issue(officer_, "4711\n").status, 200);
    auto station = opened_.station();
    const Bytes image = read_file(opened_.school().sit(station.tickets()[0]["text"]));
    hash_ = to_hex(sha256(image));
    station.hand_in(image);
    const json filed = Opened::outcome(station, hash_);
    ASSERT_EQ(filed["state"], "filed") << filed;
    session_ = filed["entry"];
  }
  [[nodiscard]] records::LedgerEntry last() const { return opened_.content().entries.back(); }
  [[nodiscard]] std::string who_sat() const {
    return records::read_registry(opened_.content()).sessions.at(0).candidate;
  }
  [[nodiscard]] json appeal() const { return examiner_.get("/api/appeals").json()["appeals"][0]; }

  Opened opened_;
  Visitor officer_ = opened_.signed_in(Role::officer),
          examiner_ = opened_.signed_in(Role::examiner);
  std::string hash_;
  std::uint64_t session_ = 0;
};

TEST_F(AfterTheExam, AnAppealIsOpenedByTheOfficerAndAnsweredByTheExaminerEachWithReason) {
  EXPECT_EQ(officer_.post("/api/appeals/open", {{"session", session_}}).status, 400)
      << "without a reason";
  EXPECT_EQ(officer_.post("/api/appeals/open", {{"session", session_}, {"reason", "  "}}).status,
            400)
      << "blanks are none";
  EXPECT_EQ(examiner_.post("/api/appeals/open", {{"session", session_}, {"reason", "x"}}).status,
            403);
  EXPECT_EQ(
      examiner_.post("/api/decide", {{"session", session_}, {"verdict", "fail"}, {"reason", "x"}})
          .status,
      400)
      << "nothing to decide";
  const std::string told =
      examiner_.post("/api/decide", {{"session", session_}, {"verdict", "fail"}, {"reason", "x"}})
          .json()["error"];
  EXPECT_EQ(told.find("--"), std::string::npos) << "no option of the command line: " << told;
  ASSERT_EQ(officer_
                .post("/api/appeals/open",
                      {{"session", session_}, {"reason", "the floor was probed twice"}})
                .status,
            200);
  EXPECT_NE(last().as<records::AppealEntry>(), nullptr);
  EXPECT_EQ(last().by.account, "The officer");
  EXPECT_EQ(officer_.post("/api/appeals/open", {{"session", session_}, {"reason", "again"}}).status,
            400);
  EXPECT_EQ(appeal()["open"], true);
  EXPECT_FALSE(appeal().contains("name")) << "an examiner sees no name";
  EXPECT_EQ(officer_
                .post("/api/appeals/answer",
                      {{"session", session_}, {"outcome", "stands"}, {"reason", "x"}})
                .status,
            403);
  EXPECT_EQ(examiner_
                .post("/api/appeals/answer",
                      {{"session", session_}, {"outcome", "changed"}, {"reason", "x"}})
                .status,
            400)
      << "nothing changed";
  ASSERT_EQ(examiner_
                .post("/api/decide",
                      {{"session", session_}, {"verdict", "fail"}, {"reason", "a wall is thin"}})
                .status,
            200);
  ASSERT_EQ(examiner_
                .post("/api/appeals/answer",
                      {{"session", session_}, {"outcome", "changed"}, {"reason", "measured again"}})
                .status,
            200);
  EXPECT_EQ(last().by.account, "The examiner");
  EXPECT_EQ(appeal()["open"], false);
  EXPECT_EQ(appeal()["answer"], "measured again");
  EXPECT_EQ(appeal()["verdict"], "fail");
  EXPECT_EQ(examiner_
                .post("/api/appeals/answer",
                      {{"session", session_}, {"outcome", "stands"}, {"reason", "x"}})
                .status,
            400)
      << "once";
  EXPECT_TRUE(records::read_registry(opened_.content()).findings.empty());
}

TEST_F(AfterTheExam, AResultIsTakenBackWithReasonAndSecondFactorOnly) {
  ASSERT_EQ(
      officer_
          .post("/api/release", {{"all", true}, {"reason", "board"}, {"code", opened_.code(-1)}})
          .json()["released"],
      1);
  ASSERT_NE(officer_.get("/api/gradebook.csv").body.find("\n4711,"), std::string::npos);
  EXPECT_EQ(officer_
                .post("/api/retract",
                      {{"sessions", {session_}}, {"reason", "wrong tooth"}, {"code", "000000"}})
                .status,
            400);
  EXPECT_EQ(
      officer_.post("/api/retract", {{"sessions", {session_}}, {"code", opened_.code()}}).status,
      400)
      << "without a reason";
  ASSERT_EQ(
      officer_
          .post("/api/retract",
                {{"sessions", {session_}}, {"reason", "wrong tooth"}, {"code", opened_.code(1)}})
          .status,
      200);
  EXPECT_NE(last().as<records::RetractEntry>(), nullptr);
  EXPECT_EQ(last().by.reason, "wrong tooth");
  EXPECT_EQ(officer_.get("/api/gradebook.csv").body.find("\n4711,"), std::string::npos);
  EXPECT_EQ(officer_.get("/api/results").json()["results"][0]["state"], "taken back");
  EXPECT_TRUE(records::read_registry(opened_.content()).findings.empty());
}

TEST_F(AfterTheExam, WhatWasTakenBackGoesOutByNameOnlyAndNothingThatThePageDidNotShow) {
  const auto row = [&] { return officer_.get("/api/results").json()["results"][0]; };
  ASSERT_EQ(
      officer_
          .post("/api/release",
                {{"results", {row()["result"]}}, {"reason", "board"}, {"code", opened_.code(-1)}})
          .json()["released"],
      1);
  ASSERT_EQ(
      officer_
          .post("/api/retract",
                {{"sessions", {session_}}, {"reason", "wrong tooth"}, {"code", opened_.code()}})
          .status,
      200);
  EXPECT_EQ(row()["state"], "taken back");
  EXPECT_EQ(row()["why_back"], "wrong tooth");
  const json all =
      officer_.post("/api/release", {{"all", true}, {"reason", "board"}, {"code", opened_.code(1)}})
          .json();
  EXPECT_EQ(all["released"], 0);
  EXPECT_EQ(all["withheld"], 1);

  const json shown = row()["result"];
  ASSERT_EQ(officer_
                .post("/api/appeals/open",
                      {{"session", session_}, {"reason", "the floor was probed twice"}})
                .status,
            200);
  ASSERT_EQ(examiner_
                .post("/api/decide",
                      {{"session", session_}, {"verdict", "fail"}, {"reason", "a wall is thin"}})
                .status,
            200);
  ASSERT_EQ(officer_
                .post("/api/incidents",
                      {{"station", ""}, {"candidate", who_sat()}, {"words", "the stylus trembled"}})
                .status,
            200);
  EXPECT_EQ(row()["state"], "ready") << "another result was entered since";
  EXPECT_EQ(appeal()["decided"]["by"], "The examiner");
  EXPECT_EQ(appeal()["decided"]["counts"], true);
  EXPECT_EQ(appeal()["noted"][0]["words"], "the stylus trembled");
  opened_.accounts().set("Otto", Role::officer, k_password, true);  // the other's codes are used
  Visitor otto(opened_.port());
  ASSERT_EQ(otto.sign_in("Otto", k_password).status, 200);
  EXPECT_EQ(
      otto.post("/api/release",
                {{"results", {shown}}, {"reason", "board"}, {"code", opened_.code_of("Otto")}})
          .status,
      400)
      << "the page showed another result";
}

TEST_F(AfterTheExam, WhatIsOutIsShownBesideWhatWouldGoOutNext) {
  ASSERT_EQ(
      officer_
          .post("/api/release", {{"all", true}, {"reason", "board"}, {"code", opened_.code(-1)}})
          .json()["released"],
      1);
  const json released = officer_.get("/api/results").json()["results"][0];
  EXPECT_FALSE(released.contains("out"));
  ASSERT_EQ(officer_
                .post("/api/appeals/open",
                      {{"session", session_}, {"reason", "the floor was probed twice"}})
                .status,
            200);
  const std::string other = released["verdict"] == "pass" ? "fail" : "pass";
  ASSERT_EQ(examiner_
                .post("/api/decide",
                      {{"session", session_}, {"verdict", other}, {"reason", "a wall is thin"}})
                .status,
            200);
  EXPECT_EQ(examiner_
                .post("/api/appeals/answer",
                      {{"session", session_}, {"outcome", "stands"}, {"reason", "x"}})
                .status,
            400)
      << "it was changed";
  const json row = officer_.get("/api/results").json()["results"][0];
  EXPECT_EQ(row["verdict"], other);
  EXPECT_EQ(row["state"], "ready");
  EXPECT_EQ(row["out"], (json{{"verdict", released["verdict"]}, {"points", released["points"]}}));
}

TEST_F(AfterTheExam, WhoHasSatIsGivenAnotherAttemptOnlyWhenAskedForAndTheLastThatIsReleasedCounts) {
  const json refused = opened_.issue(officer_, "4711\n4712\n").json();
  ASSERT_EQ(refused["issued"].size(), 1u);
  EXPECT_EQ(refused["issued"][0]["id"], "4712");
  EXPECT_NE(refused["refused"][0]["why"].get<std::string>().find("block_cavity"), std::string::npos)
      << refused;
  ASSERT_EQ(opened_.issue(officer_, "4711\n", false, true).json()["issued"].size(), 1u);
  auto station = opened_.station();
  std::string again;
  for (const json& t : station.tickets())
    if (records::parse_ticket(t["text"], "", "t").candidate == who_sat()) again = t["text"];
  const Bytes image = read_file(opened_.school().sit(again));
  station.hand_in(image);
  const json filed = Opened::outcome(station, to_hex(sha256(image)));
  ASSERT_EQ(filed["state"], "filed") << filed;
  ASSERT_EQ(
      officer_
          .post("/api/release", {{"all", true}, {"reason", "board"}, {"code", opened_.code(-1)}})
          .json()["released"],
      2);
  const json results = officer_.get("/api/results").json()["results"];
  EXPECT_EQ(results[0]["later"], filed["entry"]);
  EXPECT_FALSE(results[1].contains("later"));
}

TEST_F(AfterTheExam, TheTrailTellsEveryEntryOnceAndNamesOnlyToTheOfficer) {
  ASSERT_EQ(officer_
                .post("/api/incidents",
                      {{"station", ""}, {"candidate", who_sat()}, {"words", "spilt water"}})
                .status,
            200);
  ASSERT_EQ(
      officer_.post("/api/appeals/open", {{"session", session_}, {"reason", "the floor"}}).status,
      200);
  ASSERT_EQ(officer_.post("/api/hold", {{"reason", "alarm"}, {"to", {{"all", true}}}}).status, 200);
  const json all = officer_.post("/api/trail", json::object()).json();
  const auto entries = opened_.content().entries;
  ASSERT_EQ(all["entries"].size(), entries.size());
  EXPECT_FALSE(all.contains("earlier"));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const json& row = all["entries"][i];
    const auto& e = entries[entries.size() - 1 - i];
    EXPECT_EQ(row["entry"], e.seq);
    EXPECT_EQ(row["utc"], utc_text(e.utc_ns));
    EXPECT_TRUE(row["what"].get<std::string>().starts_with(records::kind_name(*e.what))) << row;
  }
  EXPECT_EQ(all["entries"][0]["what"], "hold");
  EXPECT_EQ(all["entries"][0]["why"], "alarm");
  EXPECT_EQ(all["entries"][2]["why"], "spilt water");
  const json before =
      officer_.post("/api/trail", {{"before", entries.size() - 3}}).json()["entries"];
  ASSERT_EQ(before.size(), entries.size() - 3);
  EXPECT_EQ(before[0]["entry"], entries.size() - 4);
  ASSERT_EQ(opened_.issue(officer_, "4712\n4713\n").status, 200);
  {
    auto ledger = opened_.school().ledger();
    const std::uint64_t last_ticket = ledger.content().entries.size() - 1;
    static_cast<void>(records::seat_candidates(ledger, {{last_ticket - 1, ""}, {last_ticket, ""}}));
  }
  EXPECT_EQ(officer_.post("/api/trail", json::object()).json()["entries"][0]["people"],
            json::array())
      << "of two the number is told";
  EXPECT_EQ(
      officer_.post("/api/trail", {{"about", "4713"}}).json()["entries"][0]["people"][0]["id"],
      "4713")
      << "who is asked for, and not the first";
  const json his = officer_.post("/api/trail", {{"about", "4711"}}).json()["entries"];
  std::vector<std::string> what;
  for (const json& row : his) {
    what.push_back(row["what"]);
    EXPECT_EQ(row["people"][0], (json{{"candidate", who_sat()}, {"id", "4711"}, {"name", ""}}));
  }
  EXPECT_EQ(what, (std::vector<std::string>{"appeal", "incident", "session", "ticket"}));
  EXPECT_EQ(examiner_.post("/api/trail", {{"about", "4711"}}).json()["entries"].size(), 0u)
      << "whose number that is he is not told";
  const json seen = examiner_.post("/api/trail", {{"about", who_sat()}}).json()["entries"];
  ASSERT_EQ(seen.size(), 4u);
  EXPECT_EQ(seen[1]["why"], "") << "what was said of somebody";
  EXPECT_EQ(seen.dump().find("4711"), std::string::npos);
  EXPECT_EQ(opened_.signed_in(Role::invigilator).post("/api/trail", json::object()).status, 403);
}

TEST_F(AfterTheExam, AReportRunsItsOwnScriptAloneAndReachesNothingOfTheOffice) {
  EXPECT_EQ(examiner_.get("/api/queue").status, 200);
  const Heard report = examiner_.get("/api/report/" + hash_);
  ASSERT_EQ(report.status, 200) << report.body;
  EXPECT_NE(report.body.find(hash_), std::string::npos);
  const std::string policy = report.fields.at("content-security-policy");
  EXPECT_NE(
      policy.find("script-src 'sha256-" + records::to_base64(sha256(std::string("1"))) + "';"),
      std::string::npos)
      << policy;
  EXPECT_NE(policy.find("sandbox allow-scripts"), std::string::npos);
  for (const char* no :
       {"allow-same-origin", "allow-top-navigation", "connect-src", "script-src 'unsafe-inline'"})
    EXPECT_EQ(policy.find(no), std::string::npos) << policy;
  EXPECT_EQ(examiner_.get("/api/report/" + std::string(64, 'a')).status, 400) << "not filed";
  EXPECT_EQ(opened_.signed_in(Role::invigilator).get("/api/report/" + hash_).status, 403);
  EXPECT_EQ(opened_.visitor().get("/api/report/" + hash_).status, 401);
}

}  // namespace
}  // namespace cavum::office
