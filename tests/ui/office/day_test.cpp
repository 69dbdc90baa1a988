// An exam day at the office: what stations are told, pauses, incidents, who is not here, seats, and
// one candidate at two stations.
#include "engine/base/json_fields.h"
#include "grading/records/station_ticket.h"
#include "tests/ui/office/opened.h"
#include "ui/office/board.h"
#include "ui/office/day_parts.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using nlohmann::json;

/// An office with two stations: that of CAVUM_HOME, and Seat 2.
class ADay : public ::testing::Test {
 protected:
  ADay()
      : key_(load_signing_key(opened_.school().file("seat2.key"), "station")),
        officer_(opened_.signed_in(Role::officer)) {
    const std::string code =
        officer_.post("/api/stations/invite", {{"name", "Seat 2"}}).json()["code"];
    second_ = std::make_unique<StationClient>(opened_.address(), opened_.certificate(),
                                              opened_.content().public_key, key_);
    static_cast<void>(
        second_->enrol(records::station_request(key_, opened_.content().public_key, {}, code)));
    first_ = std::make_unique<StationClient>(opened_.address(), opened_.certificate(),
                                             opened_.content().public_key,
                                             load_station_key(station_key_path()));
  }
  [[nodiscard]] json row(const std::string& name) const {
    const json board = officer_.get("/api/board").json();
    for (const json& s : board["stations"])
      if (s["name"] == name) return s;
    return {};
  }
  static json free(std::uint64_t heard = 0) { return {{"state", "free"}, {"heard", heard}}; }
  /// A candidate sits there.
  static json sat(std::uint64_t heard = 0, const char* state = "exam") {
    return {{"state", state}, {"candidate", "C-1"}, {"here_s", 30}, {"heard", heard}};
  }
  [[nodiscard]] records::LedgerEntry last() const { return opened_.content().entries.back(); }

  Opened opened_;
  SigningKey key_;
  Visitor officer_;
  std::unique_ptr<StationClient> first_, second_;
};

TEST_F(ADay, AnAnnouncementReachesItsStationsUntilTheyHaveReadIt) {
  const std::string seat2 = to_hex(key_.public_key);
  const Visitor invigilator = opened_.signed_in(Role::invigilator);
  const json to_one = invigilator
                          .post("/api/announce", {{"text", "Your time is 25 % longer."},
                                                  {"to", {{"station", seat2}}}})
                          .json();
  EXPECT_NE(last().as<records::AnnounceEntry>(), nullptr);
  EXPECT_EQ(last().by.account, "The invigilator");
  EXPECT_EQ(last().as<records::AnnounceEntry>()->audience.stations,
            std::vector<std::string>{seat2});
  EXPECT_TRUE(first_->report(free())["announcements"].empty());
  EXPECT_EQ(second_->report(free())["announcements"].size(), 1u)
      << "just made: who comes in now sees it";
  EXPECT_EQ(row("Seat 2")["unread"], 0) << "nobody is there to read it";
  const json told = second_->report(sat())["announcements"];
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0]["text"], "Your time is 25 % longer.");
  EXPECT_EQ(told[0]["entry"], to_one["entry"]);
  EXPECT_EQ(row("Seat 2")["unread"], 1);
  EXPECT_EQ(row("Seat 1")["unread"], 0);
  EXPECT_TRUE(second_->report(sat(to_one["entry"]))["announcements"].empty());
  EXPECT_EQ(row("Seat 2")["unread"], 0);
  static_cast<void>(second_->report(sat(0, "ended")));
  EXPECT_EQ(row("Seat 2")["unread"], 0) << "his exam is over";

  EXPECT_EQ(invigilator.post("/api/announce", {{"text", "x"}, {"to", {{"room", "Room 2"}}}}).status,
            400)
      << "nobody is there";
  EXPECT_EQ(officer_.post("/api/stations/room", {{"public_key", seat2}, {"room", "Room 2"}}).status,
            200);
  EXPECT_EQ(row("Seat 2")["room"], "Room 2");
  EXPECT_EQ(
      invigilator.post("/api/announce", {{"text", "To the room"}, {"to", {{"room", "Room 2"}}}})
          .status,
      200);
  EXPECT_EQ(invigilator.post("/api/announce", {{"text", "To all"}, {"to", {{"all", true}}}}).status,
            200);
  EXPECT_EQ(first_->report(free())["announcements"].size(), 1u);
  EXPECT_EQ(second_->report(free(to_one["entry"]))["announcements"].size(), 2u);
  for (const json& wrong :
       {json{{"text", "x"}}, json{{"text", "x"}, {"to", json::object()}},
        json{{"to", {{"all", true}}}}, json{{"text", "x"}, {"to", {{"all", 1}}}},
        json{{"text", "x"}, {"to", {{"station", "no key"}}}}})
    EXPECT_EQ(invigilator.post("/api/announce", wrong).status, 400) << wrong;
}

TEST(AnnouncedTo, ACandidateSeesWhatWasAnnouncedSinceHeSignedInOrShortlyBefore) {
  constexpr std::int64_t k_s = 1'000'000'000, k_now = 1'790'000'000 * k_s;
  records::ExamDay day;
  for (const std::int64_t ago_s : {3700, 1080, 130, 110, 5})
    day.announcements.push_back({day.announcements.size() + 1, k_now - ago_s * k_s, "x", {}});
  day.announcements.push_back({6, k_now, "to others", {"", {"bb"}}});
  const auto seen = [&](std::int64_t since) {
    std::vector<std::uint64_t> out;
    for (const auto* a : announced_to(day, "aa", since, k_now)) out.push_back(a->seq);
    return out;
  };
  using Entries = std::vector<std::uint64_t>;
  EXPECT_EQ(seen(k_now), (Entries{4, 5}))
      << "\"Ten minutes left\" of 18 minutes ago was the sitting before";
  EXPECT_EQ(seen(k_now - 100 * k_s), (Entries{3, 4, 5}));
  EXPECT_EQ(seen(k_now - 1'000 * k_s), (Entries{2, 3, 4, 5}));
  EXPECT_EQ(seen(k_now - 7'200 * k_s), (Entries{2, 3, 4, 5})) << "an hour at most";
  EXPECT_EQ(seen(0), (Entries{4, 5})) << "nobody signed in: who does now";
  const auto unread = [&](std::int64_t since, AtStation state, std::uint64_t heard) {
    StationStatus said;
    said.since_utc_ns = since;
    said.state = state;
    said.heard = heard;
    return unread_by(day, "aa", {{"aa", said}}, k_now);
  };
  EXPECT_EQ(unread(k_now, AtStation::check, 0), 2u);
  EXPECT_EQ(unread(k_now, AtStation::exam, 4), 1u);
  EXPECT_EQ(unread(0, AtStation::free, 0), 0u);
  EXPECT_EQ(unread(k_now, AtStation::ended, 0), 0u);
}

TEST(AnnouncedTo, AStationOfBeforeSaysNotSinceWhenItsCandidateIsThere) {
  Board board;
  StationReport r;
  board.report("aa", r, 1'000);
  EXPECT_EQ(board.since_utc_ns("aa"), 0);
  r.candidate = "C-1";
  board.report("aa", r, 2'000);
  board.report("aa", r, 3'000);
  EXPECT_EQ(board.since_utc_ns("aa"), 2'000) << "since it was first heard of";
  r.candidate = "C-2";
  board.report("aa", r, 4'000);
  EXPECT_EQ(board.since_utc_ns("aa"), 4'000) << "another one";
  r.here_s = 60;
  board.report("aa", r, 100'000'000'000);
  EXPECT_EQ(board.since_utc_ns("aa"), 40'000'000'000) << "the station knows it better";
  EXPECT_EQ(board.stations().at("aa").since_utc_ns, 40'000'000'000);
  const auto here_s = [](const json& said) {
    return static_cast<std::int64_t>(json_value_of<StationReport>(said, asked_json()).here_s);
  };
  EXPECT_THROW(static_cast<void>(here_s({{"state", "exam"}, {"here_s", -2}})), Error);
  EXPECT_EQ(here_s({{"state", "exam"}}), -1);
  EXPECT_EQ(here_s({{"state", "exam"}, {"here_s", 12}}), 12);
}

TEST_F(ADay, APauseForAllHoldsEveryStationUntilItGoesOn) {
  const Visitor invigilator = opened_.signed_in(Role::invigilator);
  EXPECT_TRUE(first_->report(free())["hold"].is_null());
  const json held =
      invigilator.post("/api/hold", {{"reason", "fire alarm"}, {"to", {{"all", true}}}}).json();
  for (StationClient* station : {first_.get(), second_.get()}) {
    const json hold = station->report(free())["hold"];
    EXPECT_EQ(hold["entry"], held["entry"]);
    EXPECT_EQ(hold["reason"], "fire alarm");
  }
  EXPECT_EQ(row("Seat 1")["hold"], held["entry"]);
  EXPECT_EQ(officer_.get("/api/board").json()["holds"].size(), 1u);
  EXPECT_EQ(invigilator.post("/api/go-on", {{"hold", held["entry"]}}).status, 400)
      << "without a reason";
  EXPECT_EQ(
      invigilator.post("/api/go-on", {{"hold", held["entry"]}, {"reason", "all clear"}}).status,
      200);
  EXPECT_NE(last().as<records::GoOnEntry>(), nullptr);
  EXPECT_EQ(last().by.account, "The invigilator");
  EXPECT_TRUE(first_->report(free())["hold"].is_null());
  EXPECT_EQ(invigilator.post("/api/go-on", {{"hold", held["entry"]}, {"reason", "again"}}).status,
            400);
}

TEST_F(ADay, AnIncidentIsAnEntryWithStationCandidateTimeAndWords) {
  ASSERT_EQ(opened_.issue(officer_, "4711\n").status, 200);
  const std::string candidate = first_->tickets()[0]["candidate"];
  const Visitor invigilator = opened_.signed_in(Role::invigilator);
  const json noted = invigilator
                         .post("/api/incidents", {{"station", to_hex(key_.public_key)},
                                                  {"candidate", candidate},
                                                  {"words", "spilt water"}})
                         .json();
  EXPECT_EQ(last().seq, noted["entry"]);
  EXPECT_NE(last().as<records::IncidentEntry>(), nullptr);
  const json shown = invigilator.get("/api/incidents").json()["incidents"];
  ASSERT_EQ(shown.size(), 1u);
  EXPECT_EQ(shown[0]["station"], "Seat 2");
  EXPECT_EQ(shown[0]["id"], "4711");
  EXPECT_EQ(shown[0]["words"], "spilt water");
  EXPECT_EQ(shown[0]["by"], "The invigilator");
  EXPECT_EQ(shown[0]["utc"], utc_text(last().utc_ns));
  EXPECT_EQ(invigilator.post("/api/incidents", {{"words", ""}}).status, 400);
}

TEST_F(ADay, WhoIsNotHereStandsThereByNameUntilAStationHasHim) {
  json asked = Opened::list("id,name\n4711,Anna A.\n4712,Bert B.\n4713,Cleo C.\n");
  const std::int64_t now = read_clocks().utc_ns;
  asked.update({{"exam", "block_cavity"},
                {"from", utc_text(now - 60'000'000'000)},
                {"until", utc_text(now + k_hour_ns)},
                {"reason", "class"}});
  ASSERT_EQ(officer_.post("/api/roster/issue", asked).status, 200);
  const auto missing = [&] {
    std::vector<std::string> names;
    const json all = officer_.get("/api/attendance").json();
    for (const json& m : all["missing"]) names.push_back(m["name"]);
    return names;
  };
  EXPECT_EQ(missing(), (std::vector<std::string>{"Anna A.", "Bert B.", "Cleo C."}));
  const json tickets = first_->tickets();
  first_->report({{"state", "check"}, {"candidate", tickets[0]["candidate"]}});
  EXPECT_EQ(missing(), (std::vector<std::string>{"Bert B.", "Cleo C."}))
      << "a station without the word has seen her";
  static_cast<void>(second_->begin(tickets[1]["nonce"]));
  EXPECT_EQ(missing(), std::vector<std::string>{"Cleo C."});
  const json all = officer_.get("/api/tickets").json();
  EXPECT_EQ(
      officer_
          .post("/api/tickets/cancel", {{"entry", all["tickets"][2]["entry"]}, {"reason", "ill"}})
          .status,
      200);
  EXPECT_TRUE(missing().empty());
}

TEST_F(ADay, OneCandidateAtTwoStationsIsNoticedAtOnce) {
  ASSERT_EQ(opened_.issue(officer_, "4711\n4712\n").status, 200);
  const json t = first_->tickets()[0];
  const json sits = {{"state", "exam"}, {"candidate", t["candidate"]}};
  first_->report(sits);
  EXPECT_TRUE(row("Seat 1")["twins"].empty());
  second_->report(sits);  // a copied ticket, and no network when it began
  EXPECT_EQ(row("Seat 1")["twins"], json{"Seat 2"});
  EXPECT_EQ(row("Seat 2")["twins"], json{"Seat 1"});
  second_->report({{"state", "ended"}, {"candidate", t["candidate"]}});
  EXPECT_TRUE(row("Seat 1")["twins"].empty());
  second_->report(free());
  static_cast<void>(first_->begin(t["nonce"]));
  EXPECT_THROW(static_cast<void>(second_->begin(t["nonce"])), Error);
  EXPECT_EQ(row("Seat 1")["twins"], json{"Seat 2"}) << "it asked for what the first has";
  EXPECT_EQ(row("Seat 2")["report"]["refused"], t["candidate"]);
  EXPECT_EQ(row("Seat 2")["twins"], json{"Seat 1"});
  second_->report({{"state", "check"}, {"candidate", first_->tickets()[1]["candidate"]}});
  EXPECT_TRUE(row("Seat 1")["twins"].empty()) << "somebody else sits there now";
  EXPECT_TRUE(row("Seat 2")["twins"].empty());
}

TEST_F(ADay, ASittingIsSeatedWithoutGivingAStationTwice) {
  ASSERT_EQ(opened_.issue(officer_, "1\n2\n3\n").status, 200);
  const auto tickets = [&] { return officer_.get("/api/tickets").json()["tickets"]; };
  const json t = tickets()[0], sitting = {{"exam", t["exam"]},
                                          {"not_before", t["not_before"]},
                                          {"not_after", t["not_after"]}};
  const json done = officer_.post("/api/seats", {{"sitting", sitting}}).json();
  EXPECT_EQ(done["seated"], 2);
  EXPECT_EQ(done["left"], 1);
  EXPECT_NE(last().as<records::SeatsEntry>(), nullptr);
  const json after = tickets();
  EXPECT_NE(after[0]["seat"], "");
  EXPECT_NE(after[1]["seat"], "");
  EXPECT_NE(after[0]["seat"], after[1]["seat"]);
  EXPECT_EQ(after[2]["seat"], "");
  EXPECT_EQ(officer_.post("/api/seats", {{"sitting", sitting}}).status, 400)
      << "no station is free";
  EXPECT_EQ(officer_.post("/api/seats", {{"ticket", t["entry"]}, {"station", ""}}).status, 200);
  EXPECT_EQ(officer_.post("/api/seats", {{"sitting", sitting}, {"room", "Room 2"}}).status, 400)
      << "no station stands there";
  EXPECT_EQ(officer_.post("/api/seats", {{"sitting", sitting}}).json()["seated"], 1);
}

/// Words of a PDF, by poppler.
std::string words_of(const std::string& pdf, const std::string& path) {
  write_text_file(path, pdf);
  const std::string text = path + ".txt";
  EXPECT_EQ(std::system(("pdftotext -layout " + path + " " + text).c_str()), 0);
  return read_text_file(text);
}

/// Where a word stands on its page, pt from its top, by poppler.
double line_of(const std::string& word, const std::string& pdf) {
  EXPECT_EQ(std::system(("pdftotext -bbox " + pdf + " " + pdf + ".html").c_str()), 0);
  const std::string page = read_text_file(pdf + ".html");
  const auto end = page.find(">" + word + "</word>"), at = page.rfind("yMin=\"", end);
  EXPECT_NE(end, std::string::npos) << word;
  return end == std::string::npos ? 0 : std::stod(page.substr(at + 6));
}

TEST_F(ADay, ListAndTicketsSayHowLongTheExamIs) {
  const json list =
      Opened::list("id,extra_time_percent,extra_time_s\n4711,25,\n4712,,90\n4713,,\n");
  const json preview = officer_.post("/api/roster/preview", list).json();
  EXPECT_EQ(officer_.get("/api/exams").json()["exams"][0]["time_limit_s"], 120);
  EXPECT_EQ(preview["longest_s"]["block_cavity"], 210) << "120 s and 90 s; 25 % are 30 s";
  EXPECT_EQ(officer_.get("/api/tickets").json()["exams"].size(), 0u) << "no ticket is good";
  json asked = list;
  asked.update({{"exam", "block_cavity"},
                {"from", "2031-01-21T08:00:00Z"},
                {"until", "2031-01-21T11:30:00Z"},
                {"reason", "class"}});
  ASSERT_EQ(officer_.post("/api/roster/issue", asked).status, 200);
  const json exam = officer_.get("/api/tickets").json()["exams"].at(0);
  EXPECT_EQ(exam["time_limit_s"], 120);
  EXPECT_EQ(exam["longest_s"], 210);
  EXPECT_FALSE(opened_.signed_in(Role::invigilator)
                   .get("/api/tickets")
                   .json()["exams"]
                   .at(0)
                   .contains("longest_s"))
      << "it may tell of health";
  const std::string sheet = opened_.school().file("rows.pdf");
  write_text_file(sheet, officer_.get("/api/sign-in-sheet.pdf").body);
  for (const auto& [upper, lower] : {std::pair("4711", "4712"), std::pair("4712", "4713")}) {
    const double apart_mm = (line_of(lower, sheet) - line_of(upper, sheet)) / 72 * 25.4;
    EXPECT_GE(apart_mm, 10) << "room to sign";
    EXPECT_LE(apart_mm, 20);
  }
}

TEST_F(ADay, CardsAndSheetSayWhoWhenAndWhereInANamedTimeZone) {
  EXPECT_EQ(officer_.get("/api/cards.pdf").status, 400) << "nobody is invited";
  json asked = Opened::list("id,name,extra_time_percent\n4711,Anna Ärmel,25\n4712,Bert B.,\n");
  asked.update({{"exam", "block_cavity"},
                {"from", "2031-01-21T08:00:00Z"},
                {"until", "2031-01-21T11:30:00Z"},
                {"reason", "class"}});
  ASSERT_EQ(officer_.post("/api/roster/issue", asked).status, 200);
  const json t = officer_.get("/api/tickets").json()["tickets"][0];
  EXPECT_NE(t["accommodations"].get<std::string>().find("25 %"), std::string::npos);
  EXPECT_FALSE(opened_.signed_in(Role::invigilator)
                   .get("/api/tickets")
                   .json()["tickets"][0]
                   .contains("accommodations"))
      << "it may tell of health";
  ASSERT_EQ(
      officer_
          .post("/api/stations/room", {{"public_key", to_hex(key_.public_key)}, {"room", "Room 2"}})
          .status,
      200);
  EXPECT_EQ(
      officer_.post("/api/seats", {{"ticket", t["entry"]}, {"station", to_hex(key_.public_key)}})
          .status,
      200);
  const Heard cards = officer_.get("/api/cards.pdf");
  ASSERT_EQ(cards.status, 200);
  EXPECT_EQ(cards.fields.at("content-type"), "application/pdf");
  const std::string card = words_of(cards.body, opened_.school().file("cards.pdf"));
  const std::string sheet =
      words_of(officer_.get("/api/sign-in-sheet.pdf").body, opened_.school().file("sheet.pdf"));
  const std::time_t moment = 1'926'748'800;  // 2031-01-21 08:00 UTC
  char local[64];
  std::strftime(local, sizeof local, "%Y-%m-%d %H:%M", std::localtime(&moment));
  for (const std::string& words : {card, sheet}) {
    for (const char* part : {"Anna Ärmel", "4711", "Bert B.", "Room 2", "Seat 2", "UTC",
                             static_cast<const char*>(local)})
      EXPECT_NE(words.find(part), std::string::npos) << part << " in\n" << words;
    EXPECT_NE(words.find(t["candidate"].get<std::string>()), std::string::npos);
  }
  for (const std::string& words : {card, sheet})
    EXPECT_NE(words.find("Round cavity in a layered block"), std::string::npos) << words;
  EXPECT_NE(card.find("25 %"), std::string::npos) << "the candidate is told what is granted\n"
                                                  << card;
  EXPECT_EQ(sheet.find("25 %"), std::string::npos) << "the sheet goes from hand to hand\n" << sheet;
  std::filesystem::create_directories(CAVUM_PICTURES "/office");
  for (const char* name : {"cards", "sheet"})  // to be looked at
    std::filesystem::copy_file(opened_.school().file(std::string(name) + ".pdf"),
                               std::string(CAVUM_PICTURES "/office/") + name + ".pdf",
                               std::filesystem::copy_options::overwrite_existing);
}

}  // namespace
}  // namespace cavum::office
