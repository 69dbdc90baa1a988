// The station as a candidate and a supervisor meet it: the real program with a real window on a
// virtual screen, its keys pressed by a script. What counts is what it leaves behind: sessions that
// verify or can be resumed, and ticks that know nothing of the window.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "engine/session/session_reader.h"
#include "scenarios/exam/live_exam.h"
#include "scenarios/operators/candidate_device.h"
#include "tests/ui/station/station_window.h"
#include "ui/station/picture_file.h"

namespace cavum::station {
namespace {

using namespace std::chrono_literals;

#ifdef __SANITIZE_THREAD__
constexpr bool k_in_time = false;  // the servo comes many times later than it should, and the
                                   // operator's work suffers as a person's would
#else
constexpr bool k_in_time = true;
#endif

TEST_F(StationWindow, LeadsACandidateFromSignInToASealedResult) {
  const std::string script = R"(type A17
sleep 0.2
picture 1-sign-in
go device-check
sleep 1
picture 2-device-check
go briefing
sleep 0.3
picture 3-briefing
key enter
wait exam
until 4
picture 4-exam
memory early
until 12
key 2
sleep 0.4
picture 5-exam-from-the-side
memory late
key 1
wait result
sleep 0.5
picture 6-result
key f2
sleep 0.5
key enter
)";
  std::filesystem::remove_all(CAVUM_PICTURES);
  size_.clear();  // as on a desk: people look at these pictures
  EXPECT_EQ(run(script), 0) << said();
  const VerifyReport verified = verify_session(session());
  EXPECT_TRUE(verified.verified) << testing_basics::text_of(verified.findings);
  EXPECT_EQ(verified.first_divergence, std::nullopt);
  const SessionReader reader(session());
  EXPECT_EQ(reader.setup().candidate, "A17");
  const auto result = nlohmann::json::parse(reader.result_json());
  if (k_in_time) {
    EXPECT_EQ(result["verdict"], "pass") << result["verdict_reasons"];
  }
  for (const auto& e : reader.event_rows()) EXPECT_EQ(e.as<ServoDisagrees>(), nullptr);
  EXPECT_TRUE(read_text_file(folder_.file("s.html")).starts_with("<!"));
  // every screen has its picture, and no two are alike
  std::set<std::string> pictures;
  for (const char* name : {"1-sign-in", "2-device-check", "3-briefing", "4-exam",
                           "5-exam-from-the-side", "6-result"}) {
    const std::string png = read_text_file(std::string(CAVUM_PICTURES) + "/" + name + ".png");
    EXPECT_GT(png.size(), 20000u) << name << " is nearly empty";
    pictures.insert(png);
  }
  EXPECT_EQ(pictures.size(), 6u);
  double early = 0, late = 0;
  ASSERT_EQ(std::sscanf(printed().c_str(), "early: %lf MB\nlate: %lf MB", &early, &late), 2)
      << printed();
  std::printf("memory after 4 s %.1f MB, after 12 s %.1f MB; pictures in %s\n", early, late,
              CAVUM_PICTURES);
  EXPECT_LT(late - early, 25.0);
}

TEST_F(StationWindow, ClosedDuringTheExamLeavesASessionToResume) {
  EXPECT_EQ(run(std::string(k_to_exam) + "until 2\nclose\nsleep 0.5\nkey f4\nsleep 30\nfail\n"), 1);
  EXPECT_NE(said().find(session()), std::string::npos) << "what is to be resumed: " << said();
  expect_resumable(2000);
}

TEST_F(StationWindow, AFailureInItsThreadLeavesASessionToResume) {
  EXPECT_EQ(run(std::string(k_to_exam) + "until 2\nfail\n"), 2);
  EXPECT_NE(said().find(session()), std::string::npos) << "what is to be resumed: " << said();
  expect_resumable(2000);
}

/// The station on a disk that is really full: of 90 kB, of a mount that only its own process sees;
/// temporary files have another.
class StationOnAFullDisk : public StationWindow {
 protected:
  void SetUp() override {
    StationWindow::SetUp();
    if (IsSkipped()) return;
    for (const std::string& folder : {small(), temporary()})
      std::filesystem::create_directories(folder);
    if (std::system(
            ("unshare -m mount -t tmpfs -o size=90k none " + small() + " 2>/dev/null").c_str()) !=
        0)
      GTEST_SKIP() << "no file system of a limited size can be mounted here (unshare, tmpfs)";
  }
  [[nodiscard]] std::string small() const { return folder_.file("small"); }
  [[nodiscard]] std::string temporary() const { return folder_.file("temporary"); }
  [[nodiscard]] pid_t start_full(const std::string& script) const {
    write_text_file(folder_.file("script"), script);
    for (const char* name : {"out", "err"}) write_text_file(folder_.file(name), "");
    const std::string command = "TMPDIR=" + temporary() +
                                " exec unshare -m sh -c 'mount -t tmpfs -o size=90k none " +
                                small() + " && exec " CAVUM_BINARY " station " + k_scenario +
                                " --device simulated --out " + small() + "/s.cavum --script " +
                                folder_.file("script") + " --pictures " CAVUM_PICTURES " >" +
                                folder_.file("out") + " 2>" + folder_.file("err") + "'";
    return start_command(command);
  }
  /// Everything that was done is at the rescue's place, whole, and the candidate's own.
  void expect_rescued(double least_s) const {
    const std::string saved = temporary() + "/s-rescued.cavum";
    ASSERT_TRUE(std::filesystem::exists(saved)) << said();
    EXPECT_NE(said().find(saved), std::string::npos) << said();
    const VerifyReport report = verify_session(saved);
    EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
    EXPECT_GE(static_cast<double>(report.ticks), 1000.0 * least_s);
    EXPECT_EQ(SessionReader(saved).setup().candidate, "T5");
  }
};

TEST_F(StationOnAFullDisk, ClosingTheWindowAsksFirstAndSavesEverythingElsewhere) {
  const std::string script =
      std::string(k_to_exam) +
      "until 8\nkey escape\nsleep 0.3\nkey enter\nwait save\nclose\nsleep 0.5\npicture 11-not-saved\nkey escape\nsleep 0.3\n"
      "memory still-open\nclose\nsleep 0.5\nkey enter\nsleep 30\nfail\n";
  EXPECT_EQ(wait(start_full(script)), 0) << said();
  EXPECT_NE(printed().find("still-open"), std::string::npos)
      << "it stayed open when it was asked to close: " << printed();
  expect_rescued(8);
}

TEST_F(StationOnAFullDisk, ASignalSavesEverythingElsewhereAndSaysWhere) {
  const std::string seen =
      CAVUM_PICTURES "/13-unsaved.png";  // the script's way to say how far it is
  std::filesystem::remove(seen);
  const pid_t child = start_full(
      std::string(k_to_exam) +
      "until 8\nkey escape\nsleep 0.3\nkey enter\nwait save\nsleep 0.3\npicture 13-unsaved\nsleep 290\nfail\n");
  for (int i = 0; i < 2400 && !std::filesystem::exists(seen); ++i)
    std::this_thread::sleep_for(100ms);
  ::kill(child, SIGTERM);
  EXPECT_EQ(wait(child), 0) << said();
  expect_rescued(8);
}

class StationSignal : public StationWindow, public ::testing::WithParamInterface<int> {};

TEST_P(StationSignal, LeavesASessionToResume) {
  const pid_t child = start(k_to_exam);
  const auto ticks = [this] {
    try {
      return std::filesystem::exists(session()) ? SessionReader(session()).ticks() : 0;
    } catch (const Error&) {  // just being made
      return std::int64_t{0};
    }
  };
  for (int i = 0; i < 600 && ticks() < 2000; ++i) std::this_thread::sleep_for(100ms);
  ASSERT_GE(ticks(), 2000);
  ::kill(child, GetParam());
  const int ended = wait(child);
  EXPECT_EQ(ended, GetParam() == SIGKILL ? -SIGKILL : 1) << said();
  expect_resumable(2000);
}
INSTANTIATE_TEST_SUITE_P(Signals, StationSignal, ::testing::Values(SIGTERM, SIGINT, SIGKILL),
                         [](const auto& chosen) {
                           return std::string(chosen.param == SIGTERM  ? "Term"
                                              : chosen.param == SIGINT ? "Int"
                                                                       : "Kill");
                         });

TEST_F(StationWindow, ClosedAtSignInLeavesNoSession) {
  EXPECT_EQ(run("sleep 0.2\nclose\n"), 0) << said();
  EXPECT_FALSE(std::filesystem::exists(session()));
}

TEST_F(StationWindow, AnExamEndedByTheCandidateIsGradedAsItIs) {
  EXPECT_EQ(run(std::string(k_to_exam) +
                "until 2\nkey escape\nsleep 0.3\nkey enter\nwait result\nkey enter\n"),
            0)
      << said();
  EXPECT_TRUE(verify_session(session()).verified);
  EXPECT_EQ(nlohmann::json::parse(SessionReader(session()).result_json())["verdict"], "fail");
}

TEST_F(StationWindow, TheReportButtonOfTheResultWritesTheReportOfThisExam) {
  EXPECT_EQ(
      run(std::string(k_to_exam) +
          "until 3\nkey escape\nsleep 0.3\nkey enter\nwait result\nsleep 0.3\nkey f2\nsleep 0.3\npicture 12-report-written\n"
          "key enter\n"),
      0)
      << said();
  const std::string report = folder_.file("s.html");
  ASSERT_TRUE(std::filesystem::exists(report)) << said();
  const std::string html = read_text_file(report);
  const auto result = nlohmann::json::parse(SessionReader(session()).result_json());
  EXPECT_NE(html.find("<div class='verdict " + result["verdict"].get<std::string>() + "'>"),
            std::string::npos)
      << result["verdict"];
  EXPECT_NE(html.find(" T5"), std::string::npos);
  for (const auto& c : result["criteria"]) {
    char points[64];
    std::snprintf(points, sizeof points, "%.1f", c["points"].get<double>());
    const auto row = html.find("<td>" + c["title"].get<std::string>() + "</td>");
    ASSERT_NE(row, std::string::npos) << c["title"];
    EXPECT_NE(html.substr(row, 400).find(points), std::string::npos) << c["title"] << " " << points;
  }
  EXPECT_TRUE(html.ends_with("</html>\n"));
  // the same file as the command writes of the sealed session
  ASSERT_EQ(std::system((CAVUM_BINARY " report " + session() + " --no-replay --for student --out " +
                         folder_.file("again.html") + " >" + folder_.file("out"))
                            .c_str()),
            0);
  EXPECT_TRUE(html == read_text_file(folder_.file("again.html")));
}

TEST_F(StationWindow, PracticeSaysSoInTheSession) {
  EXPECT_EQ(
      run(std::string(k_to_exam) +
              "until 6\npicture 7-practice\nkey escape\nsleep 0.3\nkey enter\nwait result\nkey enter\n",
          "--practice --high-contrast"),
      0)
      << said();
  EXPECT_EQ(SessionReader(session()).fact("note.practice"), "true");
  EXPECT_TRUE(verify_session(session()).verified);
}

TEST_F(StationWindow, BurAndSpeedChosenAtTheDeskAreRecordedInput) {
  // F9 is the second allowed bur; each [ takes a tenth of the speed away
  EXPECT_EQ(
      run(std::string(k_to_exam) +
          "until 1\nkey f9\nkey [\nkey [\nkey [\nuntil 6\nkey escape\nsleep 0.3\nkey enter\nwait result\nkey enter\n"),
      0)
      << said();
  EXPECT_TRUE(verify_session(session()).verified);
  const auto inputs = SessionReader(session()).inputs();
  EXPECT_EQ(inputs.front().bur, 0);
  EXPECT_EQ(inputs.back().bur, 1);
  double most = 0;
  for (std::size_t i = inputs.size() * 3 / 4; i < inputs.size(); ++i)
    most = std::max(most, inputs[i].pedal());
  EXPECT_NEAR(most, 0.7, 1e-4);
}

/// The first ticks of a session, up to the first that the servo made up for because the computer
/// was late: from there on the simulated hand, which acts on what it saw, goes another way in every
/// run, window or not.
struct Prefix {
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;
  std::vector<std::uint64_t> hashes;  // after each whole second
};
Prefix prefix_of(const std::string& path, std::size_t most) {
  const SessionReader reader(path);
  Prefix p{reader.inputs(), reader.records(), {}};
  std::size_t n = 0;
  while (n < most && n < p.inputs.size() && (p.inputs[n].flags & k_stylus_fresh) != 0) ++n;
  p.inputs.resize(n);
  p.records.resize(n);
  for (const ChunkRow& c : reader.chunks())
    if (static_cast<std::size_t>(c.first_tick + c.ticks) <= n) p.hashes.push_back(c.state_hash);
  return p;
}

/// The same exam without any window, for `seconds`.
void run_without_window(const std::string& path, double seconds) {
  scenarios::ExamOptions options;
  options.candidate = "T5";
  options.position_quantum_mm = OmniModel{}.quantum_mm;
  const auto setup = scenarios::prepare_exam(k_scenario, options);
  const auto device = scenarios::make_candidate_device(*setup, "expert", 1);
  scenarios::LiveExam live(*setup, path, *device, device->start_mm());
  live.start();
  while (static_cast<double>(live.view().ticks) < 1000.0 * seconds)
    std::this_thread::sleep_for(20ms);
  live.ask_to_end();
  while (live.running()) std::this_thread::sleep_for(5ms);
  EXPECT_EQ(live.finish().first_disagreement, -1);
  live.exam().close("{}");
}

TEST_F(StationWindow, OpenHiddenStalledOrAbsentTheTicksAreTheSame) {
  constexpr std::size_t k_ticks = 5000, k_enough = 4000;
  struct Way {
    std::string name, script, more;
  };
  const std::vector<Way> ways{{"open", "until 5.2\n", ""},
                              {"hidden", "until 1\nhide\nuntil 4\nshow\nuntil 5.2\n", ""},
                              {"stalled", "until 1.5\nstall 2\nuntil 5.2\n", ""},
                              {"with spray", "until 5.2\n", "--effects 2"},
                              {"spray off", "key n\nuntil 5.2\n", "--effects 2"},
                              {"absent", "", ""}};
  // a late computer cuts a run short: it is asked again, a few times
  constexpr int k_tries = 4;
  std::vector<Prefix> runs;
  for (const auto& [name, script, more] : ways) {
    Prefix longest;
    for (int i = 0; i < k_tries && longest.inputs.size() < k_enough; ++i) {
      std::filesystem::remove(session());
      if (script.empty()) {
        run_without_window(session(), 5.2);
      } else {
        ASSERT_EQ(
            run(k_to_exam + script + "key escape\nsleep 0.3\nkey enter\nwait result\nkey enter\n",
                more),
            0)
            << said();
      }
      EXPECT_TRUE(verify_session(session()).verified) << name;
      if (Prefix p = prefix_of(session(), k_ticks); p.inputs.size() > longest.inputs.size())
        longest = std::move(p);
    }
    std::printf("window %s: %zu ticks without a late one\n", name.c_str(), longest.inputs.size());
    runs.push_back(std::move(longest));
  }
  for (std::size_t i = 1; i < runs.size(); ++i) {
    const std::size_t n = std::min(runs[0].inputs.size(), runs[i].inputs.size()),
                      seconds = std::min(runs[0].hashes.size(), runs[i].hashes.size());
    EXPECT_GT(n, 200u) << "the computer is too busy to say anything";
    for (std::size_t t = 0; t < n; ++t) {
      ASSERT_EQ(runs[0].inputs[t], runs[i].inputs[t]) << ways[i].name << ", tick " << t;
      ASSERT_EQ(runs[0].records[t], runs[i].records[t]) << ways[i].name << ", tick " << t;
    }
    for (std::size_t s = 0; s < seconds; ++s)
      ASSERT_EQ(runs[0].hashes[s], runs[i].hashes[s]) << ways[i].name << ", second " << s;
  }
}

TEST_F(StationWindow, MouseAndKeyboardCutByTheSamePhysics) {
  const std::string way_down =
      k_in_time ? "2.5" : "25";  // the hand moves a tenth of a second's way a picture at most
  const std::string script = std::string(k_to_exam_by_hand) + R"(hold space
hold pagedown
until )" + way_down + R"(
picture 9-mouse-left-handed
release pagedown
release space
sleep 0.3
key escape
sleep 0.3
key enter
wait result
key enter
)";
  EXPECT_EQ(run(script, "--device mouse --practice --left-handed --text-scale 1.3"), 0) << said();
  EXPECT_TRUE(verify_session(session()).verified);
  const SessionReader reader(session());
  EXPECT_EQ(reader.setup().source.name, "mouse");
  EXPECT_GT(reader.removed().size(), 50u)
      << "4 mm/s downwards from 4 mm above reaches the block after a second";
  double most_n = 0;  // the hand went on, and the tooth pushed back
  for (const TickRecord& r : reader.records()) most_n = std::max(most_n, 1e-6 * r.model_un);
  EXPECT_GT(most_n, 0.3);
}

TEST_F(StationWindow, BBringsALostBurBackToWhereItBegan) {
  const std::string script = std::string(k_to_exam_by_hand) + R"(until 1
hold left
hold pagedown
until )" + std::string(k_in_time ? "2.5" : "12") +
                             R"(
release left
release pagedown
sleep 0.5
key b
until )" + (k_in_time ? "6" : "40") +
                             R"(
key escape
sleep 0.3
key enter
wait result
key enter
)";
  EXPECT_EQ(run(script, "--device mouse --practice"), 0) << said();
  EXPECT_TRUE(verify_session(session()).verified);
  const auto inputs = SessionReader(session()).inputs();
  const Vec3 began = inputs.front().pose().tip_mm;
  double farthest_mm = 0.0;
  for (const TickInput& input : inputs)
    farthest_mm = std::max(farthest_mm, length(input.pose().tip_mm - began));
  EXPECT_GT(farthest_mm, 3.0) << "the keys led it away";
  EXPECT_LT(length(inputs.back().pose().tip_mm - began), 0.2);
}

TEST_F(StationWindow, PausesAsOftenAsTheScenarioPermits) {
  std::string scenario = read_text_file(k_scenario);
  scenario.insert(
      scenario.find("time_limit_s"),
      "gauges = [\"speed\", \"depth\"]\npauses = { count = 1, longest_s = 60, button = 1 }\n");
  write_text_file(folder_.file("paused.toml"), scenario);
  const std::string script = std::string(k_to_exam_by_hand) + R"(until 1
key p
sleep 1.5
picture 10-pause
key p
sleep 0.5
key p
sleep 0.5
key escape
sleep 0.3
key enter
wait result
key enter
)";
  EXPECT_EQ(run(script, "--device mouse --tooth " CAVUM_SOURCE_DIR "/tests/replay/block.cvt",
                folder_.file("paused.toml")),
            0)
      << said();
  EXPECT_TRUE(verify_session(session()).verified);
  int pauses = 0;
  std::int64_t began = 0, ended = 0;
  for (const TimedEvent& e : SessionReader(session()).events()) {
    pauses += e.as<PauseStarted>() != nullptr ? 1 : 0;
    if (e.as<PauseStarted>() != nullptr) began = e.tick;
    if (e.as<PauseEnded>() != nullptr) ended = e.tick;
    EXPECT_EQ(e.as<PauseRefused>(), nullptr) << "the second is not offered";
  }
  EXPECT_EQ(pauses, 1);
  EXPECT_GT(ended - began, 1400);
}

TEST_F(StationWindow, AReplayShowsTheExamAgainAndLeavesItAsItIs) {
  ASSERT_EQ(run(std::string(k_to_exam) +
                "until 6\nkey escape\nsleep 0.3\nkey enter\nwait result\nkey enter\n"),
            0)
      << said();
  const std::string before = read_text_file(session());
  write_text_file(
      folder_.file("again"),
      "wait replay\nkey space\nsleep 1\nkey end\nsleep 2\npicture 8-replay\nkey c\nsleep 0.5\nkey escape\n");
  const int status = std::system((CAVUM_BINARY " station --replay " + session() + " --script " +
                                  folder_.file("again") + " --pictures " CAVUM_PICTURES " >" +
                                  folder_.file("out") + " 2>" + folder_.file("err"))
                                     .c_str());
  EXPECT_EQ(status, 0) << said();
  EXPECT_EQ(read_text_file(session()), before);
  EXPECT_GT(std::filesystem::file_size(CAVUM_PICTURES "/8-replay.png"), 20000u);
}

TEST_F(StationWindow, ReadsWhatItIsToldBeforeItOpens) {
  const auto refused = [this](const std::string& arguments, const std::string& part) {
    const int status = std::system((CAVUM_BINARY " station " + arguments + " >" +
                                    folder_.file("out") + " 2>" + folder_.file("err"))
                                       .c_str());
    EXPECT_EQ(WEXITSTATUS(status), 2) << arguments;
    EXPECT_NE(said().find(part), std::string::npos) << said();
  };
  refused("", "");
  refused(k_scenario, "");
  refused(k_scenario + " --device mouse --out " + folder_.file("none/at/all"),
          folder_.file("none"));
  refused(k_scenario + " --device mouse --kiosk --out " + folder_.file(""), "supervisor");
  refused(k_scenario + " --device mouse --monitor 7 --out " + folder_.file(""), "--monitor 7");
  refused(k_scenario + " --device whistle --out " + folder_.file(""), "simulated, mouse");
  refused(k_scenario + " --device simulated --operator nobody --out " + folder_.file(""), "nobody");
  write_text_file(folder_.file("bad"), "type A\nwhistle\n");
  refused(k_scenario + " --device simulated --out " + folder_.file("") + " --script " +
              folder_.file("bad"),
          "'whistle'");
}

}  // namespace
}  // namespace cavum::station
