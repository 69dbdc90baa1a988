// `cavum exam --device` as a user runs it: in real time, stopped by a signal, resumed; and the same
// candidate with and without a clock.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <numeric>
#include <thread>

#include "engine/base/file.h"
#include "engine/physics/servo/real_time.h"
#include "engine/session/clock_check.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/tooth.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;

class ExamDevice : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("CAVUM_HOME", folder_.file("").c_str(), 1);
    ::setenv("CAVUM_DATA", (std::string(CAVUM_SOURCE_DIR) + "/data").c_str(), 1);
    write_text_file(folder_.file("task.toml"), read_text_file(std::string(CAVUM_SOURCE_DIR) +
                                                              "/tests/replay/block_cavity.toml"));
    write_file(
        folder_.file("block.cvt"),
        save_tooth(make_block(
            {6, 6, 5}, {{"enamel", 1.0}, {"dentin", 1.5}, {"pulp", 1.0}, {"dentin", 1.5}}, 0.05)));
  }
  [[nodiscard]] std::vector<std::string> exam(std::vector<std::string> more,
                                              const std::string& out) const {
    std::vector<std::string> all{CAVUM_BINARY, "exam",  folder_.file("task.toml"), "--candidate",
                                 "t",          "--out", folder_.file(out)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Starts it with what it prints in `printed`.
  [[nodiscard]] pid_t start(const std::vector<std::string>& arguments) const {
    const pid_t child = ::fork();
    if (child == 0) {
      const std::string printed = folder_.file("printed");
      if (std::freopen(printed.c_str(), "w", stdout) == nullptr ||
          std::freopen((printed + ".err").c_str(), "w", stderr) == nullptr)
        ::_exit(99);
      std::vector<char*> argv;
      for (const auto& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
      argv.push_back(nullptr);
      ::execv(argv[0], argv.data());
      ::_exit(98);
    }
    return child;
  }
  static int end_of(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string said() const { return read_text_file(folder_.file("printed.err")); }
  /// Until the session holds so many seconds.
  [[nodiscard]] bool holds(const std::string& out, std::int64_t ticks) const {
    for (int i = 0; i < 60000; ++i, std::this_thread::sleep_for(2ms)) {
      try {
        if (SessionReader(folder_.file(out)).ticks() >= ticks) return true;
      } catch (const Error&) {  // not there yet
      }
    }
    return false;
  }
  testing_basics::Folder folder_;
};

TEST_F(ExamDevice, InRealTimeItIsTheSameExamUntilATickWasLate) {
  ASSERT_EQ(end_of(start(exam({"--operator", "expert", "--seed", "5", "--json"}, "plain.cavum"))),
            0)
      << said();
  ASSERT_EQ(
      end_of(start(exam({"--device", "simulated", "--operator", "expert", "--seed", "5", "--json"},
                        "live.cavum"))),
      0)
      << said();
  const auto result = nlohmann::json::parse(read_text_file(folder_.file("printed")));
  EXPECT_EQ(result["servo"]["first_disagreement"], -1)
      << "servo and recording twin agree on every tick";
  EXPECT_GT(result["servo"]["ticks"], 5000);
  EXPECT_TRUE(verify_session(folder_.file("live.cavum")).verified);
  const SessionReader live(folder_.file("live.cavum")), plain(folder_.file("plain.cavum"));
  const auto a = live.inputs(), b = plain.inputs();
  std::size_t same = 0;
  while (same < std::min(a.size(), b.size()) && a[same] == b[same]) ++same;
  const auto late = std::find_if(
      a.begin(), a.end(), [](const TickInput& t) { return (t.flags & k_stylus_fresh) == 0; });
  std::printf("%zu of %zu ticks the same; first made-up tick %td\n", same, a.size(),
              late - a.begin());
  EXPECT_TRUE(same == std::min(a.size(), b.size()) ||
              late - a.begin() <= static_cast<std::ptrdiff_t>(same))
      << "they part where a tick was made up, not before";
  EXPECT_GT(same, 0u);
  // how punctual it was is in the session, every tick counted
  int events = 0;
  for (const auto& e : live.events()) {
    const auto* lateness = e.as<ServoLateness>();
    if (lateness == nullptr) continue;
    ++events;
    const auto& counts = lateness->servo.lateness.counts;
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}),
              lateness->servo.ticks);
  }
  EXPECT_EQ(events, 1);
  EXPECT_EQ(live.setup().notes.end() !=
                std::find(live.setup().notes.begin(), live.setup().notes.end(),
                          std::pair<std::string, std::string>("in_real_time", "yes")),
            true);
}

TEST_F(ExamDevice, ASignalLeavesASessionThatGoesOn) {
  for (const int signal : {SIGTERM, SIGINT}) {
    const std::string out = signal == SIGTERM ? "term.cavum" : "int.cavum";
    const pid_t child = start(exam({"--device", "simulated", "--operator", "expert"}, out));
    ASSERT_TRUE(holds(out, 2000));
    ::kill(child, signal);
    EXPECT_EQ(end_of(child), 1) << said();
    EXPECT_NE(said().find(out), std::string::npos) << "what is to be resumed: " << said();
    const SessionReader stopped(folder_.file(out));
    EXPECT_TRUE(stopped.findings().empty());
    EXPECT_FALSE(stopped.closed());
    const auto ticks = stopped.ticks();
    const std::vector<std::string> resume{CAVUM_BINARY, "exam", "--resume", "--out",
                                          folder_.file(out)};
    auto rest = resume;
    if (signal == SIGTERM)
      rest.insert(rest.end(), {"--device", "simulated", "--operator", "expert"});
    else
      rest.emplace_back("--end");
    EXPECT_EQ(end_of(start(rest)), 0) << said();
    const auto report = verify_session(folder_.file(out));
    EXPECT_TRUE(report.verified);
    if (signal == SIGTERM)
      EXPECT_GT(report.ticks, ticks);
    else
      EXPECT_EQ(report.ticks, ticks);
  }
}

TEST_F(ExamDevice, KilledItLosesASecondAtMostAndGoesOn) {
  const pid_t child =
      start(exam({"--device", "simulated", "--operator", "novice", "--quiet"}, "s.cavum"));
  ASSERT_TRUE(holds("s.cavum", 2000));
  const auto seen = SessionReader(folder_.file("s.cavum")).ticks();
  ::kill(child, SIGKILL);
  EXPECT_EQ(end_of(child), -1);
  EXPECT_GE(SessionReader(folder_.file("s.cavum")).ticks(), seen)
      << "what was on the disk stays there";
  EXPECT_EQ(
      end_of(start({CAVUM_BINARY, "exam", "--resume", "--out", folder_.file("s.cavum"), "--end"})),
      0)
      << said();
  const auto report = verify_session(folder_.file("s.cavum"));
  EXPECT_TRUE(report.verified);
  EXPECT_GE(report.ticks, seen);
}

TEST_F(ExamDevice, StoppedForFourSecondsTheLostTimeStandsInItsResultAndNothingIsUnexplained) {
  const pid_t child =
      start(exam({"--device", "simulated", "--operator", "expert", "--seed", "5"}, "s.cavum"));
  ASSERT_TRUE(holds("s.cavum", 2000));
  constexpr unsigned k_stopped_s = 4;
  ASSERT_EQ(::kill(child, SIGSTOP), 0);
  ::sleep(k_stopped_s);
  ASSERT_EQ(::kill(child, SIGCONT), 0);
  EXPECT_EQ(end_of(child), 0) << said();
  EXPECT_TRUE(verify_session(folder_.file("s.cavum")).verified);
  const SessionReader session(folder_.file("s.cavum"));
  const auto result = nlohmann::json::parse(session.result_json());
  const double made_up_s =
      RealTimeOptions{}.most_made_up *
      k_tick_s;  // ticks that are run at once after a pause: they count as time of the exam
  EXPECT_GE(result.value("lost_time_s", 0.0), k_stopped_s - made_up_s - k_tick_s)
      << "a stopped program gains no time unseen";
  for (const auto& remark : check_clocks(session))
    EXPECT_FALSE(remark.doubtful) << "what the recording owns up to is no finding: "
                                  << remark.message();
}

TEST_F(ExamDevice, GoesOnOnlyWithTheEncoderItWasBegunWith) {
  write_text_file(folder_.file("m.csv"),
                  "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal\n0,0,0,8,1,0,0,0,0\n60,0,0,8,1,0,0,0,0\n");
  const pid_t child = start(exam({"--motion", folder_.file("m.csv")}, "s.cavum"));  // exact places
  static_cast<void>(holds("s.cavum", 1000));
  ::kill(child, SIGKILL);
  static_cast<void>(end_of(child));
  if (SessionReader(folder_.file("s.cavum")).closed())
    GTEST_SKIP() << "it was faster than the signal";
  EXPECT_EQ(end_of(start({CAVUM_BINARY, "exam", "--resume", "--out", folder_.file("s.cavum"),
                          "--device", "simulated", "--operator", "expert"})),
            2);
  EXPECT_NE(said().find("s.cavum"), std::string::npos) << said();
}

TEST_F(ExamDevice, WhatIsMissingIsSaidBeforeAnythingIsWritten) {
  const auto refuses = [&](const std::vector<std::string>& more, const std::string& words) {
    EXPECT_EQ(end_of(start(exam(more, "x.cavum"))), 2);
    EXPECT_NE(said().find(words), std::string::npos) << said();
    EXPECT_NE(::access(folder_.file("x.cavum").c_str(), F_OK), 0);
  };
  refuses({"--device", "phantom"}, "simulated, falcon, touch");
  refuses({"--device", "simulated"}, "");
  refuses({"--device", "falcon", "--operator", "expert"}, "expert");
  refuses({"--device", "falcon"}, "");
  refuses({"--device", "touch"}, "touch");
  refuses({"--device", "simulated", "--operator", "nobody"}, "nobody");
  refuses({"--device", "simulated", "--operator", "expert", "--motion", "m.csv"}, "--motion");
}

}  // namespace
}  // namespace cavum
