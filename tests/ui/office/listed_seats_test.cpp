// The class list's column `station` is the seat: entered with the tickets, on card and sheet, and
// refused with its line where it cannot be.
#include "tests/ui/office/opened.h"
#include "ui/office/papers.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using nlohmann::json;

class ListedSeats : public ::testing::Test {
 protected:
  void SetUp() override { enrol("Seat 2", "two"); }
  void enrol(const std::string& name, const std::string& key_file) const {
    const SigningKey key = load_signing_key(opened_.school().file(key_file + ".key"), "station");
    records::Ledger ledger = opened_.school().ledger();
    const std::string code =
        records::invite_station(ledger, name, read_clocks().utc_ns + k_hour_ns);
    static_cast<void>(records::enrol_station(
        ledger, records::station_request(key, ledger.content().public_key, {}, code), 0,
        "request"));
  }
  Heard issue(const std::string& list, std::int64_t from_h = -1, std::int64_t until_h = 1) {
    const std::int64_t now = read_clocks().utc_ns;
    json asked = Opened::list(list);
    asked.update({{"exam", "block_cavity"},
                  {"from", utc_text(now + from_h * k_hour_ns)},
                  {"until", utc_text(now + until_h * k_hour_ns)},
                  {"reason", "x"}});
    return officer_.post("/api/roster/issue", asked);
  }
  std::string preview_problem(const std::string& list) {
    const json preview = officer_.post("/api/roster/preview", Opened::list(list)).json();
    return fmt::format("{}",
                       fmt::join(preview.at("problems").get<std::vector<std::string>>(), "\n"));
  }
  /// Whether `parts`, between strokes, all stand in `text`.
  static bool tells_all(const std::string& text, const std::string& parts) {
    std::istringstream in(parts);
    for (std::string part; std::getline(in, part, '|');)
      if (text.find(part) == std::string::npos) return false;
    return true;
  }
  /// Issues nothing, and says so with the line.
  void expect_refused(const std::string& list, const std::string& told) {
    const std::size_t before = opened_.content().entries.size();
    const Heard heard = issue(list);
    EXPECT_EQ(heard.status, 400) << list;
    EXPECT_TRUE(tells_all(heard.body, told)) << heard.body;
    EXPECT_EQ(opened_.content().entries.size(), before) << "no ticket of them";
  }
  Opened opened_;
  Visitor officer_ = opened_.signed_in(Role::officer);
};

TEST_F(ListedSeats, AreEnteredAndStandOnCardAndSheet) {
  ASSERT_EQ(issue("id,Station\n4711,Seat 2\n4712,\n4713,Seat 1\n").status, 200);
  const auto content = opened_.content();
  EXPECT_NE(content.entries.back().as<records::SeatsEntry>(), nullptr);
  EXPECT_EQ(content.entries.back().by.account, "The officer");
  records::Ledger ledger = opened_.school().ledger();
  std::map<std::string, std::string> places;
  for (const auto& i : invited(ledger, read_clocks().utc_ns)) places[i.id] = i.station;
  EXPECT_EQ(places, (std::map<std::string, std::string>{
                        {"4711", "Seat 2"}, {"4712", ""}, {"4713", "Seat 1"}}));
}

TEST_F(ListedSeats, ThatCannotBeAreRefusedWithTheirLine) {
  for (const auto& [list, told] : std::map<std::string, std::string>{
           {"id,station\n1,Seat 1\n2,Seat 9\n", "the list:3: station: |'Seat 9'"},
           {"id,station\n1,seat 1\n", "the list:2: station: "},
           {"id,station\n1,Seat 1\n2,\n3,Seat 1\n", "the list:4: station: |'Seat 1'"}}) {
    EXPECT_TRUE(tells_all(preview_problem(list), told)) << preview_problem(list);
    expect_refused(list, told);
  }
  ASSERT_EQ(issue("id,station\n4711,Seat 1\n").status, 200);
  expect_refused("id,station\n4712,Seat 2\n4713,Seat 1\n", "the list:3: station: |'Seat 1'");
  EXPECT_EQ(issue("id,station\n4713,Seat 1\n", 2, 3).status, 200) << "at another time it is free";
  EXPECT_EQ(issue("id,station\n4711,Seat 1\n").json()["refused"].size(), 1u)
      << "his own seat is no other's";
}

TEST_F(ListedSeats, ThatAreNoneAreAllToldAtOnce) {
  std::string list = "id,station\n0,Seat 1\n";
  for (int i = 1; i <= 23; ++i) list += fmt::format("{},Place {}\n", i, i);
  const std::string problem = preview_problem(list), refused = issue(list).json()["error"];
  for (const std::string& told : {problem, refused}) {
    EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 20) << told;
    EXPECT_TRUE(tells_all(
        told, "the list:3: station: |'Place 1'|the list:22: station: |'Place 20'|the list|3"))
        << told;
  }
  EXPECT_EQ(issue("id,station\n4711,Seat 1\n4712,Seat 2\n").status, 200);
  const std::string taken = issue("id,station\n4713,Seat 1\n4714,Seat 2\n").json()["error"];
  EXPECT_TRUE(tells_all(taken, "the list:2: station: |'Seat 1'|the list:3: station: |'Seat 2'"))
      << taken;
}

TEST_F(ListedSeats, OfSeveralSittingsFollowEachOtherInTheListsOrder) {
  const std::int64_t from = read_clocks().utc_ns / 1'000'000'000 * 1'000'000'000,
                     minute = 60'000'000'000;
  json asked = Opened::list("id\n1\n2\n3\n4\n5\n");
  asked.update({{"exam", "block_cavity"},
                {"from", utc_text(from)},
                {"until", utc_text(from + 5 * minute)},
                {"reason", "x"}});
  for (const auto& [at_once, apart] :
       std::vector<std::pair<json, json>>{{0, 30}, {2, 0}, {2, json()}, {"2", 30}, {2, 100000}}) {
    json wrong = asked;
    wrong.update({{"at_once", at_once}, {"minutes_apart", apart}});
    EXPECT_EQ(officer_.post("/api/roster/issue", wrong).status, 400) << wrong;
  }
  // the exam takes two minutes: who begins at the end of five sits until the seventh
  asked.update({{"at_once", 2}, {"minutes_apart", 5}});
  EXPECT_NE(
      officer_.post("/api/roster/issue", asked).json()["error"].get<std::string>().find(" 2 "),
      std::string::npos);
  EXPECT_EQ(officer_.get("/api/tickets").json()["tickets"].size(), 0u) << "nothing by halves";
  asked.update({{"minutes_apart", 30}});
  const json issued = officer_.post("/api/roster/issue", asked).json()["issued"];
  ASSERT_EQ(issued.size(), 5u);
  const json tickets = officer_.get("/api/tickets").json()["tickets"];
  for (std::size_t i = 0; i < 5; ++i) {
    const std::int64_t later = static_cast<std::int64_t>(i / 2) * 30 * minute;
    EXPECT_EQ(tickets[i]["id"], std::to_string(i + 1));
    EXPECT_EQ(tickets[i]["not_before"], utc_text(from + later)) << i;
    EXPECT_EQ(tickets[i]["not_after"], utc_text(from + later + 5 * minute)) << i;
    EXPECT_EQ(issued[i]["not_before"], tickets[i]["not_before"]);
  }
  asked.update({{"minutes_apart", 5}, {"another", true}});
  EXPECT_EQ(officer_.post("/api/roster/issue", asked).status, 400);
  asked["overlap"] = true;
  EXPECT_EQ(officer_.post("/api/roster/issue", asked).json()["issued"].size(), 5u) << "it was said";
}

TEST_F(ListedSeats, AListInPortionsIsTheListAsAWhole) {
  const std::int64_t from = read_clocks().utc_ns / 1'000'000'000 * 1'000'000'000,
                     minute = 60'000'000'000;
  json asked = Opened::list("id,station\n1,\n2,\n3,Seat 1\n4,\n5,Seat 2\n");
  asked.update({{"exam", "block_cavity"},
                {"from", utc_text(from)},
                {"until", utc_text(from + minute)},
                {"reason", "x"},
                {"at_once", 2},
                {"minutes_apart", 10}});
  for (const std::size_t first : {0, 2, 4}) {
    asked.update({{"first", first}, {"most", 2}});
    const json done = officer_.post("/api/roster/issue", asked).json();
    EXPECT_EQ(done["done"], std::min<std::size_t>(first + 2, 5));
    EXPECT_EQ(done["of"], 5);
  }
  const json tickets = officer_.get("/api/tickets").json()["tickets"];
  ASSERT_EQ(tickets.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(tickets[i]["id"], std::to_string(i + 1));
    EXPECT_EQ(tickets[i]["not_before"],
              utc_text(from + static_cast<std::int64_t>(i / 2) * 10 * minute))
        << i;
    EXPECT_EQ(tickets[i]["seat"].get<std::string>().empty(), i != 2 && i != 4) << i;
  }
  asked.update({{"first", 5}, {"most", 2}});
  EXPECT_EQ(officer_.post("/api/roster/issue", asked).json()["issued"].size(), 0u);
  asked["first"] = -1;
  EXPECT_EQ(officer_.post("/api/roster/issue", asked).status, 400);
}

TEST_F(ListedSeats, ARevokedStationAndANameOfTwoAreNone) {
  const json invited_now = officer_.get("/api/board").json()["stations"];
  ASSERT_EQ(officer_
                .post("/api/stations/revoke",
                      {{"public_key", invited_now[1]["public_key"]}, {"reason", "stolen"}})
                .status,
            200);
  expect_refused("id,station\n1,Seat 2\n", "the list:2: station: |'Seat 2'");
  enrol("Seat 1", "three");
  expect_refused("id,station\n1,Seat 1\n", "the list:2: station: |'Seat 1'");
}

TEST_F(ListedSeats, ByHandNeitherHaveTwoAtOneTime) {
  ASSERT_EQ(issue("id,station\n4711,Seat 1\n4712,Seat 2\n").status, 200);
  const json tickets = officer_.get("/api/tickets").json()["tickets"];
  EXPECT_EQ(
      officer_
          .post("/api/seats", {{"ticket", tickets[0]["entry"]}, {"station", tickets[1]["seat"]}})
          .status,
      400);
  EXPECT_EQ(officer_.post("/api/seats", {{"ticket", tickets[1]["entry"]}, {"station", ""}}).status,
            200);
  EXPECT_EQ(
      officer_
          .post("/api/seats", {{"ticket", tickets[0]["entry"]}, {"station", tickets[1]["seat"]}})
          .status,
      200);
}

}  // namespace
}  // namespace cavum::office
