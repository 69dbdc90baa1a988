// A station that speaks with the office by itself: tickets, board, word, pauses and recordings,
// with and without a network; and an exam's ticks, which are the same whatever the network does.
#include "ui/office/station_link.h"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <functional>

#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "grading/records/begin.h"
#include "grading/records/station_ticket.h"
#include "scenarios/exam/live_exam.h"
#include "scenarios/operators/candidate_device.h"
#include "tests/grading/records/short_exam.h"
#include "tests/ui/office/opened.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using nlohmann::json;
namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;

bool within(double seconds, const std::function<bool()>& holds) {
  const auto until = Steady::now() + std::chrono::duration<double>(seconds);
  while (Steady::now() < until) {
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return holds();
}

/// An office, and the folders of a station's tickets and recordings.
class AStation : public ::testing::Test {
 protected:
  AStation() : officer_(opened_.signed_in(Role::officer)) {
    fs::create_directories(folder("exams"));
    link_ = {opened_.address(),
             opened_.certificate(),
             opened_.content().public_key,
             folder("tickets"),
             {folder("exams")}};
  }
  [[nodiscard]] std::string folder(const std::string& name) const {
    return opened_.school().file(name);
  }
  [[nodiscard]] std::unique_ptr<StationLink> begin() const {
    return std::make_unique<StationLink>(link_, load_station_key(station_key_path()));
  }
  [[nodiscard]] json said() const {
    const json board = officer_.get("/api/board").json();
    return board["stations"][0]["report"];
  }
  /// A short exam of a ticket that was issued now.
  [[nodiscard]] std::string sit(const std::string& number) const {
    EXPECT_EQ(opened_.issue(officer_, number + "\n").status, 200);
    std::string text;
    auto station = opened_.station();
    for (const json& t : station.tickets()) text = t["text"];
    std::string path = folder("exams/" + number + ".cavum");
    sit_shortly(k_scenario, path, text);
    return path;
  }
  [[nodiscard]] std::size_t filed() const {
    return records::read_registry(opened_.content()).sessions.size();
  }

  Opened opened_;
  Visitor officer_;
  LinkOptions link_;
};

TEST_F(AStation, FetchesTicketsAndGivesBackWhatIsCancelled) {
  ASSERT_EQ(opened_.issue(officer_, "4711\n4712\n").status, 200);
  const auto link = begin();
  const auto tickets = [&] {
    std::size_t n = 0;
    for (const auto& f : fs::directory_iterator(folder("tickets")))
      n += f.path().extension() == ".ticket" ? 1 : 0;
    return n;
  };
  ASSERT_TRUE(within(10, [&] { return tickets() == 2; }));
  for (const auto& f : fs::directory_iterator(folder("tickets")))
    EXPECT_NO_THROW(static_cast<void>(records::read_ticket(f.path().string())));
  const json all = officer_.get("/api/tickets").json();
  ASSERT_EQ(
      officer_
          .post("/api/tickets/cancel", {{"entry", all["tickets"][0]["entry"]}, {"reason", "ill"}})
          .status,
      200);
  EXPECT_TRUE(within(10, [&] { return tickets() == 1; }));
  EXPECT_FALSE(fs::exists(
      folder("tickets/" + all["tickets"][0]["candidate"].get<std::string>() + ".ticket")));
  ASSERT_EQ(opened_.issue(officer_, "4713\n").status, 200);
  EXPECT_TRUE(within(10, [&] { return tickets() == 2; }));
}

TEST_F(AStation, TheBoardShowsWhatItDoesAndItHearsWhatTheOfficeSays) {
  const auto link = begin();
  ASSERT_TRUE(within(10, [&] { return link->view().reached; }));
  StationReport report;
  report.state = AtStation::exam;
  report.step = "2/5 outline";
  report.left_s = 61;
  link->say(report);
  EXPECT_TRUE(within(5, [&] { return said()["state"] == "exam" && said()["left_s"] == 61; }));
  const json told =
      officer_.post("/api/announce", {{"text", "Five minutes more."}, {"to", {{"all", true}}}})
          .json();
  ASSERT_TRUE(within(5, [&] { return link->view().told.size() == 1; }));
  EXPECT_EQ(link->view().told[0].text, "Five minutes more.");
  link->read(told["entry"]);
  EXPECT_TRUE(link->view().told.empty());
  EXPECT_TRUE(within(5, [&] { return said()["heard"] == told["entry"]; }));
  EXPECT_TRUE(link->view().told.empty());
  const json hold =
      officer_.post("/api/hold", {{"reason", "fire alarm"}, {"to", {{"all", true}}}}).json();
  ASSERT_TRUE(within(5, [&] { return link->view().hold == hold["entry"]; }));
  EXPECT_EQ(link->view().hold_reason, "fire alarm");
  opened_.close();
  EXPECT_TRUE(within(15, [&] { return !link->view().reached; }));
  EXPECT_EQ(link->view().hold, hold["entry"]) << "a pause lasts when the network does not";
  link->release(hold["entry"]);
  EXPECT_EQ(link->view().hold, 0u) << "an invigilator may decide";
}

TEST_F(AStation, AsksForTheWordAndDoesWithoutWhereThereIsNoNetwork) {
  ASSERT_EQ(opened_.issue(officer_, "4711\n").status, 200);
  auto station = opened_.station();
  const std::string nonce = station.tickets()[0]["nonce"];
  const auto link = begin();
  const std::string word = link->begin(nonce);
  EXPECT_EQ(records::parse_begin(word, opened_.content().public_key, "word").ticket, nonce);
  EXPECT_THROW(static_cast<void>(link->begin(std::string(32, '0'))), Error) << "the office says no";
  opened_.close();
  EXPECT_EQ(link->begin(nonce), "");
}

TEST_F(AStation, HandsInByItselfAlsoWhatWasSatWithoutANetworkAndBeforeItBegan) {
  const std::string first = sit("4711"), second = sit("4712");
  opened_.close();
  {
    const auto link = begin();
    EXPECT_FALSE(within(2, [&] { return link->view().reached; }));
    EXPECT_FALSE(StationLink::outcome(first));
  }
  const auto link = begin();  // at its next start, and the network comes back later
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  opened_.open();
  ASSERT_TRUE(
      within(60, [&] { return StationLink::outcome(first) && StationLink::outcome(second); }));
  EXPECT_TRUE(StationLink::outcome(first)->filed);
  EXPECT_GT(StationLink::outcome(second)->entry, 0u);
  EXPECT_EQ(filed(), 2u);
  const records::LedgerContent content = opened_.content();
  const json receipt = json::parse(read_text_file(folder("exams/4711.receipt.json")));
  EXPECT_TRUE(records::check_receipt(receipt, content.public_key, &content).empty());
  officer_ = opened_.signed_in(Role::officer);
  const std::string third = sit("4713");
  link->hand_in();
  ASSERT_TRUE(within(60, [&] { return StationLink::outcome(third).has_value(); }));
  EXPECT_EQ(filed(), 3u);
  EXPECT_TRUE(within(10, [&] { return link->view().waiting == 0; }));
}

TEST_F(AStation, HandsInNothingThatIsUnderWayOpenOrNobodysAndSaysWhatWasRefused) {
  const std::string under_way = sit("4711"), spoilt = sit("4712");
  write_text_file(folder("exams/none.cavum"), "no session");
  sit_shortly(k_scenario, folder("exams/stranger.cavum"),
              School().ticket("1"));  // another school's
  ::setenv("CAVUM_HOME", opened_.school().file("station").c_str(), 1);
  const json all = officer_.get("/api/tickets").json();
  ASSERT_EQ(
      officer_
          .post("/api/tickets/cancel", {{"entry", all["tickets"][1]["entry"]}, {"reason", "ill"}})
          .status,
      200);
  auto link = std::make_unique<StationLink>(link_, load_station_key(station_key_path()));
  link->recording(under_way);
  ASSERT_TRUE(within(60, [&] { return StationLink::outcome(spoilt).has_value(); }));
  EXPECT_FALSE(StationLink::outcome(spoilt)->filed);
  EXPECT_FALSE(StationLink::outcome(spoilt)->findings.empty());
  EXPECT_TRUE(
      within(10, [&] { return link->view().failed == std::vector<std::string>{"4712.cavum"}; }));
  EXPECT_FALSE(StationLink::outcome(under_way));
  link->recording("");
  link->hand_in();
  ASSERT_TRUE(within(60, [&] { return StationLink::outcome(under_way).has_value(); }));
  EXPECT_EQ(filed(), 1u);
  EXPECT_FALSE(StationLink::outcome(folder("exams/stranger.cavum")));
  EXPECT_FALSE(StationLink::outcome(folder("exams/none.cavum")));
}

/// Takes connections and never says a word.
class Mute {
 public:
  Mute() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&here), sizeof here), 0);
    EXPECT_EQ(::listen(socket_, 16), 0);
    socklen_t size = sizeof here;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&here), &size);
    port_ = ntohs(here.sin_port);
  }
  ~Mute() { ::close(socket_); }
  Mute(const Mute&) = delete;
  Mute& operator=(const Mute&) = delete;
  [[nodiscard]] std::string address() const { return "https://127.0.0.1:" + std::to_string(port_); }

 private:
  int socket_;
  std::uint16_t port_ = 0;
};

TEST_F(AStation, EndsWithinAMomentAndNeverWaitsWhateverTheNetworkDoes) {
  const Mute mute;
  static_cast<void>(sit("4711"));
  link_.server = mute.address();
  auto link = begin();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  for (int i = 0; i < 100; ++i) {
    const auto from = Steady::now();
    link->say({});
    static_cast<void>(link->view());
    link->hand_in();
    EXPECT_LT(std::chrono::duration<double>(Steady::now() - from).count(), 0.5)
        << "of a computer that does other things, too";
  }
  const auto from = Steady::now();
  link.reset();
  EXPECT_LT(std::chrono::duration<double>(Steady::now() - from).count(), 2.0);
}

/// The ticks of an exam up to the first for which the computer was late.
struct Ticks {
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;
};
Ticks sat(const std::string& path, double seconds) {
  scenarios::ExamOptions options;
  options.candidate = "T5";
  options.position_quantum_mm = OmniModel{}.quantum_mm;
  const auto setup = scenarios::prepare_exam(k_scenario, options);
  const auto device = scenarios::make_candidate_device(*setup, "expert", 1);
  scenarios::LiveExam live(*setup, path, *device, device->start_mm());
  live.start();
  while (static_cast<double>(live.view().ticks) < 1000.0 * seconds)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  live.ask_to_end();
  while (live.running()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(live.finish().first_disagreement, -1);
  live.exam().close("{}");
  EXPECT_TRUE(verify_session(path).verified);
  const SessionReader reader(path);
  Ticks ticks{reader.inputs(), reader.records()};
  std::size_t n = 0;
  while (n < ticks.inputs.size() && (ticks.inputs[n].flags & k_stylus_fresh) != 0) ++n;
  ticks.inputs.resize(n);
  ticks.records.resize(n);
  return ticks;
}

TEST_F(AStation, TheTicksOfAnExamAreTheSameWithAnOfficeWithOneThatIsMuteAndWithout) {
  constexpr double k_seconds = 4.0;
  constexpr int k_tries = 4;
  constexpr std::size_t k_enough = 3000;
  const Mute mute;
  std::vector<Ticks> runs;
  for (const std::string& server : {std::string(), opened_.address(), mute.address()}) {
    Ticks longest;
    for (int i = 0; i < k_tries && longest.inputs.size() < k_enough; ++i) {
      std::unique_ptr<StationLink> link;
      link_.server = server;
      if (!server.empty()) link = begin();
      const std::string path =
          folder("ticks-" + std::to_string(runs.size()) + "-" + std::to_string(i) + ".cavum");
      if (Ticks t = sat(path, k_seconds); t.inputs.size() > longest.inputs.size())
        longest = std::move(t);
    }
    std::printf("%s: %zu ticks without a late one\n", server.empty() ? "no office" : server.c_str(),
                longest.inputs.size());
    runs.push_back(std::move(longest));
  }
  for (std::size_t i = 1; i < runs.size(); ++i) {
    const std::size_t n = std::min(runs[0].inputs.size(), runs[i].inputs.size());
    EXPECT_GT(n, 200u) << "the computer is too busy to say anything";
    for (std::size_t t = 0; t < n; ++t) {
      ASSERT_EQ(runs[0].inputs[t], runs[i].inputs[t]) << "run " << i << ", tick " << t;
      ASSERT_EQ(runs[0].records[t], runs[i].records[t]) << "run " << i << ", tick " << t;
    }
  }
}

}  // namespace
}  // namespace cavum::office
