// Makeup sittings at the office: who asks and why, what is granted, and that stations know the
// makeup alone.
#include "engine/base/json_fields.h"
#include "tests/grading/records/short_exam.h"
#include "tests/ui/office/opened.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using nlohmann::json;

class OfficeMakeup : public ::testing::Test {
 protected:
  /// Issues a ticket for one candidate and returns its row of the list.
  json issued(const std::string& list, std::int64_t from_h, std::int64_t until_h) {
    const std::int64_t now = read_clocks().utc_ns;
    json asked = Opened::list(list);
    asked.update({{"exam", "block_cavity"},
                  {"from", utc_text(now + from_h * k_hour_ns)},
                  {"until", utc_text(now + until_h * k_hour_ns)},
                  {"reason", "x"}});
    EXPECT_EQ(officer_.post("/api/roster/issue", asked).status, 200);
    return officer_.get("/api/tickets").json()["tickets"].back();
  }
  Heard make_up(const json& first, const json& more = json::object()) {
    const std::int64_t now = read_clocks().utc_ns;
    json asked = {{"ticket", first["entry"]},          {"became", "interrupted"},
                  {"from", utc_text(now - k_hour_ns)}, {"until", utc_text(now + k_hour_ns)},
                  {"accommodations", "none"},          {"reason", "the power failed"}};
    asked.update(more);
    return officer_.post("/api/tickets/makeup", asked);
  }
  json row(std::uint64_t entry) {
    const json tickets = officer_.get("/api/tickets").json()["tickets"];
    for (const json& t : tickets)
      if (t["entry"] == entry) return t;
    return {};
  }
  Opened opened_;
  Visitor officer_ = opened_.signed_in(Role::officer);
};

TEST_F(OfficeMakeup, IsTheOnlyTicketThatStationsKnowAndGrantsWhatTheFirstDid) {
  const json first = issued("id,extra_time_percent,left_handed\n4711,25,yes\n", -1, 1);
  EXPECT_EQ(first["makeup"], json::array({"interrupted"})) << "its time is not over";
  auto station = opened_.station();
  const std::string before = station.tickets()[0]["text"];
  const Heard given = make_up(first, {{"accommodations", "as before"}});
  ASSERT_EQ(given.status, 200) << given.body;
  const auto last = opened_.content().entries.back();
  ASSERT_NE(last.as<records::TicketEntry>(), nullptr);
  EXPECT_EQ(last.as<records::TicketEntry>()->makes_up->ticket, first["entry"]);
  EXPECT_EQ(last.by.account, "The officer");
  EXPECT_EQ(last.by.reason, "the power failed");
  const json tickets = station.tickets();
  ASSERT_EQ(tickets.size(), 1u);
  const auto a = records::parse_ticket(before, "", "a"),
             b = records::parse_ticket(tickets[0]["text"], "", "b");
  EXPECT_NE(a.nonce, b.nonce);
  EXPECT_EQ(a.candidate, b.candidate);
  EXPECT_EQ(a.grant, b.grant);
  EXPECT_EQ(station.ask("POST", "/station/begin", json{{"ticket", a.nonce}}.dump()).status, 400);
  EXPECT_EQ(row(first["entry"])["live"], false);
  EXPECT_EQ(row(first["entry"])["became"], "interrupted");
  EXPECT_EQ(make_up(first).status, 400) << "once";
  EXPECT_EQ(officer_.get("/api/board").json()["tickets"]["made up"], 1);
}

TEST_F(OfficeMakeup, ThatIsCancelledBeforeItBeganGivesTheFirstTicketBackToStations) {
  const json first = issued("id,extra_time_percent\n4711,25\n", -1, 1);
  auto station = opened_.station();
  const std::string before = station.tickets()[0]["text"];
  ASSERT_EQ(make_up(first).status, 200);
  ASSERT_NE(station.tickets()[0]["text"], before);
  const auto makeup = opened_.content().entries.back().seq;
  const Heard again = make_up(first, {{"accommodations", "as before"}});
  EXPECT_EQ(again.status, 400) << again.body;
  ASSERT_EQ(
      officer_.post("/api/tickets/cancel", {{"entry", makeup}, {"reason", "is well again"}}).status,
      200);
  ASSERT_EQ(station.tickets().size(), 1u);
  EXPECT_EQ(station.tickets()[0]["text"], before) << "with what it granted";
  const Heard cancelled =
      officer_.post("/api/tickets/cancel", {{"entry", makeup}, {"reason", "x"}});
  EXPECT_NE(cancelled.body.find(std::to_string(makeup)), std::string::npos) << cancelled.body;
  EXPECT_EQ(cancelled.body.find("--"), std::string::npos)
      << "no option of the command line: " << cancelled.body;
}

TEST_F(OfficeMakeup, AsksForAccommodationsAndTakesNoneForGranted) {
  const json missed = issued("id,extra_time_percent\n4711,25\n", -3, -2);
  EXPECT_EQ(missed["makeup"], json::array({"missed", "interrupted"}));
  const std::size_t before = opened_.content().entries.size();
  EXPECT_EQ(make_up(missed, {{"accommodations", ""}}).status, 400);
  EXPECT_EQ(make_up(missed, {{"accommodations", "these"}, {"extra_time_percent", 0.25}}).status,
            400)
      << "a quarter more is 25";
  EXPECT_EQ(make_up(missed, {{"accommodations", "these"}}).status, 400) << "none is said";
  EXPECT_EQ(make_up(missed, {{"accommodations", "these"}, {"extra_time_percent", 4000}}).status,
            400);
  EXPECT_EQ(make_up(missed, {{"reason", ""}}).status, 400);
  EXPECT_EQ(make_up(missed, {{"became", "ill"}}).status, 400);
  EXPECT_EQ(make_up(missed, {{"until", "2020-01-01T00:00:00Z"}}).status, 400);
  EXPECT_EQ(opened_.content().entries.size(), before) << "none of all that added anything";
  EXPECT_EQ(officer_.get("/api/attendance").json()["missing"].size(), 1u);
  ASSERT_EQ(make_up(missed, {{"became", "missed"},
                             {"accommodations", "these"},
                             {"extra_time_percent", 25},
                             {"high_contrast", true}})
                .status,
            200);
  const auto grant = records::parse_ticket(opened_.station().tickets()[0]["text"], "", "t").grant;
  EXPECT_EQ(grant, (std::vector<std::pair<std::string, std::string>>{
                       {"accommodation.extra_time_percent", "25"},
                       {"accommodation.high_contrast", "true"}}));
  const json missing = officer_.get("/api/attendance").json()["missing"];
  ASSERT_EQ(missing.size(), 1u) << "the makeup alone is waited for";
  EXPECT_EQ(missing[0]["no_show"], false);
}

TEST_F(OfficeMakeup, WhoMissedTheExamHasWhatTheFirstTicketGrantedAsLongAsItIsKept) {
  const json missed = issued("id,extra_time_percent\n4711,25\n", -3, -2);
  EXPECT_TRUE(opened_.station().tickets().empty()) << "no station gets what ran out";
  EXPECT_EQ(row(missed["entry"])["grant_stored"], true);
  ASSERT_EQ(make_up(missed, {{"became", "missed"}, {"accommodations", "as before"}}).status, 200);
  EXPECT_EQ(
      records::parse_ticket(opened_.station().tickets()[0]["text"], "", "t").grant.at(0).second,
      "25");
  EXPECT_EQ(row(missed["entry"])["grant_stored"], true) << "the makeup may be cancelled still";
  auto station = opened_.station();
  static_cast<void>(
      station.begin(records::parse_ticket(station.tickets()[0]["text"], "", "t").nonce));
  static_cast<void>(station.tickets());
  EXPECT_EQ(row(missed["entry"])["grant_stored"], false) << "for nothing any more";
}

TEST_F(OfficeMakeup, WhatWasFiledTellsItsOwnGrant) {
  const json first = issued("id,extra_time_percent,left_handed\n4711,25,yes\n", -1, 1);
  auto station = opened_.station();
  const std::string ticket = station.tickets()[0]["text"];
  const Bytes image =
      read_file(opened_.school().sit(ticket, "expert", [](scenarios::ExamOptions& o) {
        o.grant = {25, {}, true, {}};
      }));
  station.hand_in(image);
  ASSERT_EQ(Opened::outcome(station, to_hex(sha256(image)))["state"], "filed");
  EXPECT_EQ(row(first["entry"])["at_station"], false);
  EXPECT_EQ(row(first["entry"])["grant_stored"], true);
  ASSERT_EQ(make_up(first, {{"accommodations", "as before"}}).status, 200);
  EXPECT_EQ(records::parse_ticket(opened_.station().tickets()[0]["text"], "", "t").grant,
            records::parse_ticket(ticket, "", "t").grant);
}

TEST_F(OfficeMakeup, TheTicketOfWhoHasBegunIsCancelledOnlyWhereThatIsMeant) {
  const json first = issued("id\n4711\n", -1, 1);
  auto station = opened_.station();
  station.report({{"state", "exam"}, {"candidate", first["candidate"]}, {"heard", 0}});
  const auto cancel = [&](const json& more) {
    json asked = {{"entry", first["entry"]}, {"reason", "wrong person"}};
    asked.update(more);
    return officer_.post("/api/tickets/cancel", asked);
  };
  const Heard refused = cancel(json::object());
  EXPECT_EQ(refused.status, 400);
  EXPECT_EQ(row(first["entry"])["begun"], true);
  EXPECT_EQ(cancel({{"begun", true}}).status, 200);
}

TEST_F(OfficeMakeup, OfTwoFiledSittingsReleasesTheMakeup) {
  const json first = issued("id\n4711\n", -1, 1);
  auto station = opened_.station();
  const auto handed = [&](const std::string& name) {
    const std::string path = opened_.school().file(name);
    sit_shortly(k_scenario, path, station.tickets()[0]["text"].get<std::string>());
    const Bytes image = read_file(path);
    station.hand_in(image);
    return Opened::outcome(station, to_hex(sha256(image)));
  };
  ASSERT_EQ(handed("a.cavum")["state"], "filed");
  ASSERT_EQ(make_up(first).status, 200);
  const json makeup = handed("b.cavum");
  ASSERT_EQ(makeup["state"], "filed") << makeup;
  const json results = officer_.get("/api/results").json()["results"];
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0]["state"], "made up");
  EXPECT_EQ(results[1]["makes_up"], first["entry"]);
  EXPECT_EQ(
      officer_
          .post("/api/release", {{"all", true}, {"reason", "board"}, {"code", opened_.code(-1)}})
          .json()["released"],
      1);
  const std::string book = officer_.get("/api/gradebook.csv").body;
  EXPECT_NE(book.find(fmt::format(" {})", first["entry"].get<int>())), std::string::npos)
      << "which it makes up: " << book;
  EXPECT_TRUE(records::read_registry(opened_.content()).findings.empty());
}

}  // namespace
}  // namespace cavum::office
