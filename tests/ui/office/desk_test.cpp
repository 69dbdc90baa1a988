// What people do at the office: every action is an entry with who and why, and the ledger holds
// afterwards.
#include "grading/records/regrade.h"
#include "tests/ui/office/opened.h"
#include "ui/language/language.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using nlohmann::json;

TEST(Desk, FromRosterToGradebookEachActionIsAnEntryWithWhoAndWhy) {
  const Opened opened;
  const Visitor officer = opened.signed_in(Role::officer),
                examiner = opened.signed_in(Role::examiner),
                reader = opened.signed_in(Role::reader);
  const auto last = [&] { return opened.content().entries.back(); };
  EXPECT_EQ(officer.get("/api/exams").json()["exams"][0]["id"], "block_cavity");
  const Heard issued = opened.issue(officer, "4711\n4712\n");
  ASSERT_EQ(issued.status, 200) << issued.body;
  EXPECT_EQ(issued.json()["issued"].size(), 2u);
  EXPECT_NE(last().as<records::TicketEntry>(), nullptr);
  EXPECT_EQ(last().by.account, "The officer");
  EXPECT_EQ(last().by.reason, "the class of this year");
  const json again = opened.issue(officer, "4711\n").json();
  EXPECT_EQ(again["issued"].size(), 0u);
  EXPECT_EQ(again["refused"][0]["id"], "4711");

  auto station = opened.station();
  const Bytes image = read_file(opened.school().sit(station.tickets()[0]["text"]));
  station.hand_in(image);
  const json filed = Opened::outcome(station, to_hex(sha256(image)));
  ASSERT_EQ(filed["state"], "filed") << filed;
  {  // as if the program had left it to a person
    records::Ledger ledger = opened.school().ledger();
    json review = *records::read_registry(ledger.content()).sessions.at(0).result;
    review["verdict"] = "review";
    review["verdict_reasons"] =
        json::array({to_json(grading::finding<grading::FindingKind::force_without_tissue>())});
    records::enter_regrade(ledger, filed["entry"], review, {}, "as if");
    EXPECT_TRUE(ledger.content().entries.back().by.account.empty()) << "nobody signed in for that";
  }
  const json queue = examiner.get("/api/queue").json()["queue"];
  ASSERT_EQ(queue.size(), 1u);
  EXPECT_EQ(queue[0]["reasons"].size(), 1u);
  EXPECT_EQ(queue[0].contains("name"), false) << "an examiner sees no name";
  EXPECT_EQ(examiner.get("/api/results").json()["results"][0].contains("name"), false);
  EXPECT_EQ(officer.get("/api/results").json()["results"][0]["id"], "4711");
  const std::string code = opened.code();
  EXPECT_EQ(
      officer.post("/api/release", {{"all", true}, {"reason", "board of May"}, {"code", code}})
          .json()["to_decide"],
      1);
  EXPECT_EQ(examiner.post("/api/decide", {{"session", filed["entry"]}, {"verdict", "pass"}}).status,
            400)
      << "without a reason";
  EXPECT_EQ(examiner
                .post("/api/decide", {{"session", filed["entry"]},
                                      {"verdict", "pass"},
                                      {"reason", "looked at it"},
                                      {"person", "Somebody Else"}})
                .status,
            200);
  EXPECT_EQ(last().as<records::RegradeEntry>()->person, "The examiner")
      << "whoever signed in, whatever the request says";
  EXPECT_EQ(last().by.account, "The examiner");
  EXPECT_EQ(last().by.reason, "looked at it");

  const auto entries = opened.content().entries.size();
  std::set<std::string> told;  // by another sentence each
  for (const std::string& bad : {std::string("000000"), code}) {
    const auto refused =
        officer.post("/api/release", {{"all", true}, {"reason", "board of May"}, {"code", bad}});
    EXPECT_EQ(refused.status, 400) << "a code is good once";
    told.insert(refused.body);
  }
  EXPECT_EQ(told.size(), 2u);
  EXPECT_EQ(opened.content().entries.size(), entries);
  EXPECT_EQ(officer.get("/api/gradebook.csv").body.find("4711"), std::string::npos)
      << "not before its release";
  // the code of the next step is good already: nobody waits half a minute here
  const auto secret = from_base32(opened.accounts().of("The officer")->code_secret);
  const std::string next = one_time_code(
      *secret,
      static_cast<std::uint64_t>(read_clocks().utc_ns / 1'000'000'000 / k_code_step_s) + 1);
  EXPECT_EQ(
      officer.post("/api/release", {{"all", true}, {"reason", "board of May"}, {"code", next}})
          .json()["released"],
      1);
  EXPECT_EQ(last().by.reason, "board of May");
  EXPECT_NE(officer.get("/api/gradebook.csv").body.find("\n4711,"), std::string::npos);
  const Heard criteria = reader.get("/api/criteria.csv");
  EXPECT_EQ(criteria.body.find("4711"), std::string::npos) << "pseudonyms alone";
  EXPECT_NE(criteria.fields.at("content-disposition").find("criteria.csv"), std::string::npos);

  const records::LedgerContent content = opened.content();
  EXPECT_TRUE(content.findings.empty()) << english_text(content.findings.front().message());
  EXPECT_TRUE(records::read_registry(content).findings.empty());
}

TEST(Desk, AGradebookOfARehearsalHasWhatNoHandMovedMarkedAndUnderNoNumber) {
  Opened opened;
  opened.rehearse();
  opened.close();
  opened.open();
  const Visitor officer = opened.signed_in(Role::officer);
  const std::string candidate = opened.issue(officer, "4711\n").json()["issued"][0]["candidate"];
  auto station = opened.station();
  const Bytes image = read_file(opened.school().sit(
      station.tickets()[0]["text"], "expert",
      [](scenarios::ExamOptions& o) { o.notes.emplace_back("operator", "expert"); }));
  station.hand_in(image);
  const json filed = Opened::outcome(station, to_hex(sha256(image)));
  ASSERT_EQ(filed["state"], "filed") << filed;
  ASSERT_EQ(
      officer
          .post("/api/release", {{"all", true}, {"reason", "rehearsal"}, {"code", opened.code()}})
          .json()["released"],
      1);
  const auto book = [&] { return opened.signed_in(Role::officer).get("/api/gradebook.csv").body; };
  EXPECT_NE(book().find("\nSIMULATED " + candidate + ","), std::string::npos) << book();
  EXPECT_EQ(book().find("4711"), std::string::npos);
}

TEST(Desk, NothingIsIssuedWhileAColumnWaitsForItsAnswer) {
  const Opened opened;
  const Visitor officer = opened.signed_in(Role::officer);
  json asked = Opened::list("id,Seat\n1,3\n");
  asked.update({{"exam", "block_cavity"},
                {"from", "2026-01-01T00:00Z"},
                {"until", "2036-01-01T00:00Z"},
                {"reason", "class"}});
  EXPECT_EQ(officer.post("/api/roster/issue", asked).status, 400);
  const auto refused = [&](const char* name, const json& value) {
    json other = asked;
    other["answers"] = {"", "pass over"};
    other[name] = value;
    EXPECT_EQ(officer.post("/api/roster/issue", other).status, 400) << name;
  };
  refused("exam", "/etc/passwd");
  refused("from", "tomorrow");
  refused("until", "2025-01-01T00:00Z");
  refused("reason", "");
  refused("reason", "two\nlines");
  refused("base64", "%%%");
  EXPECT_EQ(opened.content().entries.size(), k_first_entries);
  asked["answers"] = {"", "pass over"};
  EXPECT_EQ(officer.post("/api/roster/issue", asked).status, 200);
  EXPECT_EQ(opened.content().entries.size(), k_first_entries + 1);
}

TEST(Desk, WhyAnExamWasRefusedIsSaidInTheOfficesLanguage) {
  set_language("de");
  struct English {
    ~English() { set_language("en"); }
  } const again;
  const Opened opened;
  const Visitor officer = opened.signed_in(Role::officer);
  ASSERT_EQ(opened.issue(officer, "4711\n").status, 200);
  auto station = opened.station();
  const Bytes image(4096, 0x55);
  station.hand_in(image);
  const json told = Opened::outcome(station, to_hex(sha256(image)));
  ASSERT_EQ(told["state"], "refused") << told;
  const json shown = officer.get("/api/board").json()["inbox"]["refused"][0]["findings"][0];
  EXPECT_EQ(told["findings"][0]["kind"], shown["kind"]);
  EXPECT_NE(told["findings"][0]["text"], shown["text"]) << "what programs read is English";
}

TEST(Desk, TheBoardIsToldLive) {
  const Opened opened;
  const Visitor invigilator = opened.signed_in(Role::invigilator);
  Wire wire(opened.port());
  wire.send("GET /api/board/events HTTP/1.1\r\nHost: x\r\nCookie: __Host-cavum=" +
            invigilator.cookie + "\r\n\r\n");
  EXPECT_NE(wire.hear_for(std::chrono::milliseconds(500)).find("text/event-stream"),
            std::string::npos);
  auto station = opened.station();
  station.report({{"state", "exam"}, {"step", "Outline"}});
  const std::string told = Visitor(invigilator).get("/api/board").body;
  EXPECT_NE(told.find("Outline"), std::string::npos);
}

TEST(Desk, TheBoardIsToldThatATicketRanOutByTheClockAlone) {
  const Opened opened;
  const Visitor officer = opened.signed_in(Role::officer);
  const std::int64_t now = read_clocks().utc_ns;
  json asked = Opened::list("id\n4711\n");
  asked.update({{"exam", "block_cavity"},
                {"from", utc_text(now - k_hour_ns)},
                {"until", utc_text(now + 5'000'000'000)},
                {"reason", "class"}});
  ASSERT_EQ(officer.post("/api/roster/issue", asked).status, 200);
  Wire wire(opened.port());
  wire.send("GET /api/board/events HTTP/1.1\r\nHost: x\r\nCookie: __Host-cavum=" + officer.cookie +
            "\r\n\r\n");
  const std::string told = wire.hear_for(std::chrono::seconds(20));  // nothing happens meanwhile
  EXPECT_NE(told.find("\"live\":1"), std::string::npos) << told;
  EXPECT_NE(told.find("\"run out\":1"), std::string::npos) << told;
}

}  // namespace
}  // namespace cavum::office
