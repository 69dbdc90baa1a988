// A locked exam, and the hand on keyboard and mouse, as the X server's own events bring them: what
// is tried is in the session, and the exam goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/session/lock_event.h"
#include "engine/session/session_reader.h"
#include "tests/ui/station/station_window.h"
#include "tests/ui/station/x_hand.h"
#include "ui/station/pointer_hand.h"
#include "ui/station/station_device.h"

namespace cavum::station {
namespace {

using namespace std::chrono_literals;

class StationByHand : public StationWindow {
 protected:
  void SetUp() override {
    StationWindow::SetUp();
    if (IsSkipped()) return;
    hand_ = std::make_unique<testing_station::XHand>();
    if (!hand_->there())
      GTEST_SKIP() << "SKIPPED: no libXtst on this computer, so no key can be pressed";
  }
  /// Until the session has so many ticks.
  [[nodiscard]] bool came_to(std::int64_t ticks) const {
    for (int i = 0; i < 1200; ++i) {
      try {
        if (std::filesystem::exists(session()) && SessionReader(session()).ticks() >= ticks)
          return true;
      } catch (const Error&) {  // just being made
      }
      std::this_thread::sleep_for(50ms);
    }
    return false;
  }
  [[nodiscard]] std::vector<LockTry> attempts() const {
    std::vector<LockTry> what;
    for (const TimedEvent& e : SessionReader(session()).events())
      if (const auto* attempt = e.as<LockAttempt>()) what.push_back(attempt->what);
    return what;
  }
  [[nodiscard]] static bool holds(const std::vector<LockTry>& all, LockTry one) {
    return std::find(all.begin(), all.end(), one) != all.end();
  }
  std::unique_ptr<testing_station::XHand> hand_;
};

class LockedExam : public StationByHand {
 protected:
  void SetUp() override {
    StationByHand::SetUp();
    if (IsSkipped()) return;
    ASSERT_EQ(std::system(("echo overthelake | " CAVUM_BINARY " station --set-supervisor-code >" +
                           folder_.file("out"))
                              .c_str()),
              0);
  }
  /// The session as it stands, ended: it verifies, and says what was tried.
  void expect_told(const std::vector<LockAttempt>& attempts) const {
    ASSERT_EQ(
        std::system((CAVUM_BINARY " verify " + session() + " >" + folder_.file("verify")).c_str()),
        0)
        << read_text_file(folder_.file("verify"));
    ASSERT_EQ(std::system((CAVUM_BINARY " report " + session() + " --no-replay --out " +
                           folder_.file("r.html") + " >/dev/null")
                              .c_str()),
              0);
    for (const LockAttempt& attempt : attempts) {
      const std::string part = english_text(lock_words(attempt));
      EXPECT_NE(read_text_file(folder_.file("verify")).find(part), std::string::npos)
          << part << " in " << read_text_file(folder_.file("verify"));
      EXPECT_NE(read_text_file(folder_.file("r.html")).find(part), std::string::npos) << part;
    }
  }
};

TEST_F(LockedExam, FillsTheScreenAndClosesByTheSupervisorsCodeAlone) {
  const pid_t child = start(
      std::string(k_to_exam) +
          "type wrongcode\npicture 14-locked\nkey enter\nsleep 0.5\npicture 15-wrong-code\nkey escape\n"
          "sleep 1\ntype overthelake\nkey enter\nsleep 60\nfail\n",
      "--kiosk");
  ASSERT_TRUE(came_to(1500)) << said();
  EXPECT_EQ(hand_->size_of("Cavum"), "1280 x 800 at 0, 0") << "whatever --width says";
  EXPECT_TRUE(hand_->ask_to_close("Cavum"));
  std::this_thread::sleep_for(3s);
  const std::int64_t before = SessionReader(session()).ticks();
  ASSERT_TRUE(came_to(before + 2000)) << "it goes on: " << said();
  EXPECT_TRUE(hand_->ask_to_close("Cavum"));
  EXPECT_EQ(wait(child), 1) << said();
  expect_resumable(before + 2000);
  EXPECT_EQ(attempts(), (std::vector{LockTry::close_asked, LockTry::close_refused,
                                     LockTry::close_asked, LockTry::close_granted}));
  EXPECT_EQ(SessionReader(session()).fact("note.locked"), "yes");
  expect_told({{LockTry::close_asked}, {LockTry::close_refused}, {LockTry::close_granted, true}});
}

TEST_F(LockedExam, AnotherWindowAndASecondStartAreRecordedAndEndNothing) {
  const pid_t child = start(
      std::string(k_to_exam) +
          "until 7\npicture 16-recorded\nkey escape\nsleep 0.3\nkey enter\nwait result\nkey enter\n"
          "type overthelake\nkey enter\n",
      "--kiosk");
  ASSERT_TRUE(came_to(1500)) << said();
  hand_->take_the_keyboard(400);
  const std::string second = folder_.file("second");
  const int status = std::system((CAVUM_BINARY " station " + k_scenario + " --device mouse --out " +
                                  folder_.file("") + " 2>" + second)
                                     .c_str());
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_FALSE(read_text_file(second).empty());
  EXPECT_EQ(wait(child), 0) << said();
  const VerifyReport report = verify_session(session());
  EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
  const auto all = attempts();
  EXPECT_TRUE(holds(all, LockTry::focus_lost));
  EXPECT_TRUE(holds(all, LockTry::focus_back)) << "it takes the keyboard back";
  EXPECT_TRUE(holds(all, LockTry::second_station));
  EXPECT_FALSE(holds(all, LockTry::close_asked)) << "the exam was over by then";
  expect_told({{LockTry::focus_lost}, {LockTry::second_station}});
}

TEST_F(LockedExam, GoesOnWithoutAScreenAndFillsItAgain) {
  const pid_t child =
      start(std::string(k_to_exam) +
                "until 8\nkey escape\nsleep 0.3\nkey enter\nwait result\nkey enter\n"
                "type overthelake\nkey enter\n",
            "--kiosk");
  ASSERT_TRUE(came_to(1500)) << said();
  const bool can = hand_->unplug_screen();
  const std::int64_t before = SessionReader(session()).ticks();
  EXPECT_TRUE(came_to(before + 2000)) << "it goes on in the dark: " << said();
  EXPECT_EQ(hand_->plug_screen(), can);
  std::this_thread::sleep_for(1s);
  EXPECT_EQ(hand_->size_of("Cavum"), "1280 x 800 at 0, 0");
  EXPECT_EQ(wait(child), 0) << said();
  EXPECT_TRUE(verify_session(session()).verified);
  if (!can) GTEST_SKIP() << "this X server's screen cannot be taken away";
  EXPECT_TRUE(holds(attempts(), LockTry::screen_lost));
  EXPECT_TRUE(holds(attempts(), LockTry::screen_back));
  expect_told({{LockTry::screen_lost, false, 1}});
}

TEST_F(LockedExam, AKeyboardThatIsPluggedInIsRecorded) {
  const std::string list = folder_.file("devices");
  const auto keyboard = [](const std::string& name) {
    return "N: Name=\"" + name +
           "\"\nP: Phys=usb-2/input0\nB: KEY=1000000000007 ff9f207ac14057ff febeffdfffefffff fffffffffffffffe\n\n";
  };
  write_text_file(list, keyboard("First"));
  if (std::system(
          ("unshare -m mount --bind " + list + " /proc/bus/input/devices 2>/dev/null").c_str()) !=
      0)
    GTEST_SKIP() << "no file can be mounted here";
  write_text_file(folder_.file("script"),
                  std::string(k_to_exam) +
                      "until 6\nkey escape\nsleep 0.3\nkey enter\nwait result\nkey enter\n"
                      "type overthelake\nkey enter\n");
  const pid_t child =
      start_command("exec unshare -m sh -c 'mount --bind " + list +
                    " /proc/bus/input/devices && exec " CAVUM_BINARY " station " + k_scenario +
                    " --device simulated --kiosk --out " + session() + " --script " +
                    folder_.file("script") + " 2>" + folder_.file("err") + "'");
  ASSERT_TRUE(came_to(1500)) << said();
  std::ofstream(list, std::ios::app)
      << keyboard("Second");  // the mount follows the file, not its name
  EXPECT_EQ(wait(child), 0) << said();
  EXPECT_TRUE(verify_session(session()).verified);
  expect_told({{LockTry::keyboard_added, false, 0, "Second at usb-2/input0"}});
}

TEST_F(StationWindow, ResultsAreHeldWhereTheScenarioSaysSo) {
  std::string scenario = read_text_file(k_scenario);
  scenario.insert(scenario.find("time_limit_s"), "hold_results = true\n");
  write_text_file(folder_.file("held.toml"), scenario);
  const std::string to_result =
      std::string(k_to_exam) +
      "until 2\nkey escape\nsleep 0.3\nkey enter\nwait result\nsleep 0.3\n";
  EXPECT_EQ(run(to_result + "picture 17-held\nkey f2\nsleep 0.5\nkey enter\n",
                "--tooth " CAVUM_SOURCE_DIR "/tests/replay/block.cvt", folder_.file("held.toml")),
            0)
      << said();
  EXPECT_TRUE(verify_session(session()).verified);
  EXPECT_FALSE(std::filesystem::exists(folder_.file("s.html"))) << "no report by F2";
}

TEST_F(StationWindow, TheTutorialEndsInAFirstHoleThatThePersonDrilled) {
  const std::string script = R"(go device-check
sleep 1
key space 0.6
go briefing
key enter
wait exam
sleep 0.5
key enter
key right 1.0
key left 0.8
key d 0.6
key 1
sleep 0.2
hold ctrl
key up 0.7
release ctrl
key 0
sleep 0.3
picture 18-tutorial
hold space
key pagedown 1.5
sleep 3
key pageup 2
release space
sleep 1
picture 19-first-hole
key escape
sleep 0.3
key enter
wait result
key enter
)";
  EXPECT_EQ(run(script, "--tutorial"), 0) << said();
  const SessionReader reader(session());
  EXPECT_TRUE(verify_session(session()).verified);
  EXPECT_EQ(reader.fact("note.practice"), "true");
  std::vector<int> steps;
  for (const auto& e : reader.event_rows())
    if (const auto* done = e.as<TutorialStep>()) steps.push_back(done->step);
  EXPECT_EQ(steps, (std::vector{1, 2, 3, 4, 5, 6, 7}));
  EXPECT_GT(reader.removed().size(), 20u) << "there is a hole";
}

/// The simulated Omni comes to rest where its friction holds the hand's pull, and tells its place
/// in steps: less than a tap.
const double k_kept_back_mm =
    pointer_omni().coulomb_n / HandModel{}.stiffness_n_per_mm + pointer_omni().quantum_mm;

/// Of a mouse and keyboard in practice; `pictures_s` makes each picture last that long.
class PointerByHand : public StationByHand {
 protected:
  [[nodiscard]] pid_t start_slow(bool slow) const {
    std::string script = k_to_exam_by_hand;
    for (int i = 0; i < 70; ++i) script += slow ? "stall 0.1\n" : "sleep 0.1\n";
    return start(script + "key escape\nsleep 0.3\nkey enter\nwait result\nkey enter\n",
                 "--device mouse --practice");
  }
  [[nodiscard]] Vec3 way() const {
    const auto inputs = SessionReader(session()).inputs();
    return inputs.back().pose().tip_mm - inputs.at(400).pose().tip_mm;
  }
};

TEST_F(PointerByHand, TapsOf12MsAllCountAt10PicturesASecond) {
  for (const bool slow : {true, false}) {
    std::filesystem::remove(session());
    const pid_t child = start_slow(slow);
    ASSERT_TRUE(came_to(1000)) << said();
    for (int i = 0; i < 20; ++i) {
      hand_->tap("Prior", 12);
      std::this_thread::sleep_for(60ms);
    }
    EXPECT_EQ(wait(child), 0) << said();
    EXPECT_NEAR(way().z, 20 * k_pointer_step_mm, k_kept_back_mm) << (slow ? "slow" : "quick");
  }
}

TEST_F(PointerByHand, AHeldKeyGoesByTimeAtAnyRateOfPictures) {
  for (const bool slow : {true, false}) {
    std::filesystem::remove(session());
    const pid_t child = start_slow(slow);
    ASSERT_TRUE(came_to(1000)) << said();
    double expected_mm = 0;
    for (int i = 0; i < 3; ++i) {
      hand_->key("Prior", true);
      const auto down = std::chrono::steady_clock::now();
      std::this_thread::sleep_for(std::chrono::milliseconds(470 + 37 * i));
      const double held_s =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - down).count();
      hand_->key("Prior", false);
      expected_mm += k_pointer_step_mm + k_pointer_mm_s * (held_s - HeldKeyLaw{}.wait_s);
      std::this_thread::sleep_for(150ms);
    }
    EXPECT_EQ(wait(child), 0) << said();
    std::printf("%s: moved by %.3f mm, held for %.3f mm\n",
                slow ? "10 pictures a second" : "as quick as it draws", way().z, expected_mm);
    constexpr double k_clock_s = 0.002;  // of the server, which counts milliseconds, at each end
    EXPECT_NEAR(way().z, expected_mm, k_kept_back_mm + 3 * k_clock_s * k_pointer_mm_s)
        << (slow ? "slow" : "quick");
  }
}

/// That no edge of the screen stops it is for PointerHand's test: here the hand's own box around
/// the tooth ends sooner.
TEST_F(PointerByHand, TheMouseGoesToTheEdgeOfTheHandsBox) {
  const pid_t child = start_slow(false);
  ASSERT_TRUE(came_to(1000)) << said();
  for (int i = 0; i < 60; ++i) {
    hand_->move(50, 0);
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_EQ(wait(child), 0) << said();
  EXPECT_GT(length(way()), k_pointer_room_mm)
      << "from within the tooth's box to the edge of the room around it";
  EXPECT_LT(length(way()), 30) << "3000 pixels alone are 60 mm";
}

}  // namespace
}  // namespace cavum::station
