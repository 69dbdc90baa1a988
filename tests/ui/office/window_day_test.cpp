// The exam window itself at an exam office: the real program on a virtual screen, with a server
// that a test pauses, and takes away.
#include <signal.h>
#include <spawn.h>
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb/stb_image.h>
#include <sys/wait.h>

#include <array>
#include <map>
#include <utility>

#include "engine/base/json_fields.h"
#include "engine/session/session_reader.h"
#include "grading/records/begin.h"
#include "tests/ui/office/opened.h"
#include "tests/ui/station/virtual_screen.h"
#include "ui/office/station_link.h"

extern char** environ;

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using nlohmann::json;
namespace fs = std::filesystem;

/// The window of this school's station, with a simulated hand: its exams are filed as a rehearsal.
class AWindow : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!screen_.there())
      GTEST_SKIP() << "SKIPPED: no Xvfb on this computer, so no window can be opened";
    ::setenv("LANGUAGE", "en", 1);
    opened_.rehearse();
    opened_.close();
    opened_.open();
    officer_ = opened_.signed_in(Role::officer);
    fs::create_directories(exams());
    fs::create_directories(pictures());
  }
  ~AWindow() override {
    if (child_ > 0) {
      ::kill(child_, SIGTERM);
      ::waitpid(child_, nullptr, 0);
    }
  }
  [[nodiscard]] std::string exams() const { return opened_.school().file("exams"); }
  static std::string pictures() { return CAVUM_PICTURES "/office"; }
  /// Opens it; the script's `%` stands for the candidate's code.
  void start(const std::string& candidate, std::string script) {
    for (std::size_t at = script.find('%'); at != script.npos; at = script.find('%', at))
      script.replace(at, 1, candidate);
    const std::string file = opened_.school().file("script"), said = opened_.school().file("said");
    write_text_file(file, script);
    const std::string command = "exec " CAVUM_BINARY " station " + k_scenario +
                                " --device simulated --width 800 --height 500 --out " + exams() +
                                " --server " + opened_.address() + " --certificate " +
                                opened_.certificate() + " --script " + file + " --pictures " +
                                pictures() + " >" + said + " 2>&1";
    std::array<char*, 4> arguments{const_cast<char*>("sh"), const_cast<char*>("-c"),
                                   const_cast<char*>(command.c_str()), nullptr};
    ASSERT_EQ(::posix_spawn(&child_, "/bin/sh", nullptr, nullptr, arguments.data(), environ), 0);
  }
  /// Its exit code.
  int end() {
    int status = 0;
    ::waitpid(std::exchange(child_, 0), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  [[nodiscard]] std::string said() const { return read_text_file(opened_.school().file("said")); }
  template <class Holds>
  [[nodiscard]] bool within(double seconds, const Holds& holds) const {
    for (int i = 0; i < static_cast<int>(20 * seconds); ++i) {
      if (holds()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return holds();
  }
  [[nodiscard]] json board() const {
    const json all = officer_.get("/api/board").json();
    return all["stations"][0];
  }
  [[nodiscard]] std::string ticket(bool begin_at_office) const {
    const json issued = opened_.issue(officer_, "4711\n", begin_at_office).json();
    return issued["issued"][0]["candidate"];
  }
  /// The one recording that there is.
  [[nodiscard]] std::string recording() const {
    for (const auto& f : fs::directory_iterator(exams()))
      if (f.path().extension() == ".cavum") return f.path().string();
    return {};
  }

  /// How many pixels of a picture have exactly this colour.
  static int pixels_of(const std::string& name, const std::array<int, 3>& rgb) {
    int width = 0, height = 0, channels = 0, n = 0;
    unsigned char* pixels = stbi_load((pictures() + name).c_str(), &width, &height, &channels, 3);
    EXPECT_NE(pixels, nullptr) << name;
    for (int i = 0; pixels != nullptr && i < width * height; ++i)
      n += pixels[3 * i] == rgb[0] && pixels[3 * i + 1] == rgb[1] && pixels[3 * i + 2] == rgb[2]
               ? 1
               : 0;
    stbi_image_free(pixels);
    return n;
  }

  testing_station::VirtualScreen screen_;
  Opened opened_;
  Visitor officer_;
  pid_t child_ = 0;
};

constexpr char k_sit[] =
    "wait sign-in\nsleep 3\npicture sign-in\ntype %\ngo device-check\ngo briefing\nkey enter\nwait exam\n";

TEST_F(AWindow, SitsAnExamWithTheOfficesWordAPauseAnAnnouncementAndFilesIt) {
  const std::string candidate = ticket(true);
  start(
      candidate,
      std::string(k_sit) +
          "until 1.5\nsleep 4\npicture paused\nuntil 4\nsleep 1\npicture announcement\nkey home\nwait result\nsleep 2\npicture result\n"
          "sleep 20\npicture result-told\nsleep 600\n");
  for (const char* name : {"/result.png", "/result-told.png"}) fs::remove(pictures() + name);
  ASSERT_TRUE(within(120, [&] { return text_in(board()["report"], "state") == "exam"; })) << said();
  EXPECT_EQ(board()["report"]["candidate"], candidate);
  EXPECT_GT(board()["report"]["since_utc_ns"].get<std::int64_t>(), 0);
  EXPECT_GT(board()["report"]["left_s"], 0);
  EXPECT_FALSE(text_in(board()["report"], "step").empty());
  const json hold =
      officer_
          .post("/api/hold", {{"reason", "Fire alarm: leave the room"}, {"to", {{"all", true}}}})
          .json();
  ASSERT_TRUE(within(20, [&] { return board()["report"]["held"] == true; })) << board();
  const json left = board()["report"]["left_s"];
  std::this_thread::sleep_for(std::chrono::seconds(4));
  EXPECT_EQ(board()["report"]["left_s"], left) << "the clock stands";
  const json told =
      officer_.post("/api/announce", {{"text", "Lunch is at one."}, {"to", {{"all", true}}}})
          .json();
  ASSERT_EQ(
      officer_.post("/api/go-on", {{"hold", hold["entry"]}, {"reason", "a false alarm"}}).status,
      200);
  EXPECT_TRUE(within(20, [&] { return board()["report"]["held"] == false; }));
  ASSERT_TRUE(within(240, [&] {
    return !recording().empty() && StationLink::outcome(recording()).has_value();
  })) << said();
  const HandedIn done = *StationLink::outcome(recording());
  ASSERT_TRUE(done.filed) << done.findings.front();
  EXPECT_TRUE(within(20, [&] { return text_in(board()["report"], "state") == "ended"; }));
  ASSERT_TRUE(within(60, [&] { return fs::exists(pictures() + "/result.png"); })) << said();
  ASSERT_EQ(
      officer_
          .post("/api/announce", {{"text", "Stay in your seats, please."}, {"to", {{"all", true}}}})
          .status,
      200);
  ASSERT_TRUE(within(60, [&] { return fs::exists(pictures() + "/result-told.png"); })) << said();
  std::this_thread::sleep_for(std::chrono::seconds(1));  // it is written
  ::kill(child_, SIGTERM);
  EXPECT_EQ(end(), 0) << said();
  const std::array<int, 3> verdict{0x4c, 0xc9, 0xa4},
      frame{0xf0, 0xb7, 0x4d};  // of a pass, and of a notice
  const int before = pixels_of("/result.png", verdict),
            told_too = pixels_of("/result-told.png", verdict);
  EXPECT_EQ(pixels_of("/result.png", frame), 0);
  EXPECT_GT(pixels_of("/result-told.png", frame), 200) << "the announcement shows";
  EXPECT_GT(before, 200) << "so does the verdict";
  EXPECT_GE(told_too, before * 9 / 10) << "and is not covered";

  const SessionReader session(recording());
  std::int64_t held = 0;
  std::vector<TimedEvent> office;
  for (const TimedEvent& e : session.events()) {
    if (e.as<HoldStarted>() != nullptr) held -= e.tick;
    if (e.as<HoldEnded>() != nullptr) held += e.tick;
    if (const auto* by_office = e.as<OfficeHold>()) {
      EXPECT_EQ(by_office->entry, hold["entry"]);
    }
    if (e.as<OfficeHold>() != nullptr || e.as<Announced>() != nullptr ||
        e.as<AnnouncementRead>() != nullptr)
      office.push_back({0, e.event});
  }
  EXPECT_GE(held, 4000);
  ASSERT_EQ(office.size(), 3u);
  const std::uint64_t entry = told["entry"];
  EXPECT_NE(std::find(office.begin(), office.end(),
                      TimedEvent{0, Announced{{entry, "Lunch is at one."}}}),
            office.end());
  EXPECT_NE(std::find(office.begin(), office.end(), TimedEvent{0, AnnouncementRead{{entry}}}),
            office.end());
  const std::string word = session.fact(std::string("note.") + records::k_begin_note);
  EXPECT_EQ(records::parse_begin(word, opened_.content().public_key, "word").ledger, opened_.id());
  const json result = json::parse(session.result_json());
  const std::int64_t stood = result["pauses"]["ticks"];
  EXPECT_EQ(stood, held);
  EXPECT_EQ(result["pauses"]["list"][0]["by_office"], true);
  EXPECT_NEAR(result["time_s"].get<double>(), static_cast<double>(session.ticks() - stood) * 0.001,
              0.0015)
      << "the time is given back";
  const records::Registry registry = records::read_registry(opened_.content());
  ASSERT_EQ(registry.sessions.size(), 1u);
  EXPECT_TRUE(registry.sessions[0].findings.empty());
  EXPECT_EQ(registry.sessions[0].seq, done.entry);
}

TEST_F(AWindow, SitsOnWhenTheNetworkGoesAndFilesWhenItIsBack) {
  const std::string candidate = ticket(false);
  start(candidate, std::string(k_sit) + "wait result\nsleep 2\npicture not-handed-in\nsleep 600\n");
  ASSERT_TRUE(within(120, [&] { return text_in(board()["report"], "state") == "exam"; })) << said();
  opened_.close();
  ASSERT_TRUE(within(240, [&] {
    return !recording().empty() && SessionReader(recording()).closed();
  })) << said();
  std::this_thread::sleep_for(std::chrono::seconds(3));
  EXPECT_FALSE(StationLink::outcome(recording()));
  opened_.open();
  ASSERT_TRUE(within(90, [&] { return StationLink::outcome(recording()).has_value(); })) << said();
  EXPECT_TRUE(StationLink::outcome(recording())->filed);
  ::kill(child_, SIGTERM);
  EXPECT_EQ(end(), 0) << said();
}

TEST_F(AWindow, ATicketThatTheOfficeCancelledOrAnotherStationHasBeginsNoExam) {
  const std::string candidate = ticket(true);
  const SigningKey other = load_signing_key(opened_.school().file("seat2.key"), "station");
  const std::string code =
      officer_.post("/api/stations/invite", {{"name", "Seat 2"}}).json()["code"];
  StationClient second(opened_.address(), opened_.certificate(), opened_.content().public_key,
                       other);
  static_cast<void>(
      second.enrol(records::station_request(other, opened_.content().public_key, {}, code)));
  static_cast<void>(second.begin(second.tickets()[0]["nonce"]));
  start(
      candidate,
      "wait sign-in\nsleep 3\ntype %\nkey enter\nsleep 6\npicture refused\nwords refused\nsleep 600\n");
  const std::string words = pictures() + "/refused.txt";
  fs::remove(words);
  ASSERT_TRUE(within(90, [&] { return fs::exists(words) && !read_text_file(words).empty(); }))
      << said();
  EXPECT_EQ(board()["twins"], json{"Seat 2"}) << "noticed at once";
  EXPECT_TRUE(recording().empty());
}

}  // namespace
}  // namespace cavum::office
