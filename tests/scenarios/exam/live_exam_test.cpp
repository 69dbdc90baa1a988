// An exam in real time: the servo on its own thread and the recording twin must be one, whatever
// the machine does meanwhile.
#include "scenarios/exam/live_exam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "engine/base/file.h"
#include "engine/device/simulated_stylus.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/basics.h"

namespace cavum::scenarios {
namespace {

using namespace std::chrono_literals;
using testing_basics::comes_true;

/// The simulated Omni drilling into the middle of the block; a test may hold a button or take the
/// pedal away.
class Drilling final : public ServoDevice {
 public:
  Drilling()
      : stylus_({}, {}, 1e-3, [](double t_s) {
          return HandIntent{{0.3 * std::sin(t_s), 0, std::max(-0.9, 0.6 - t_s)},
                            t_s > 0.2 ? 1.0 : 0.0};
        }) {}
  [[nodiscard]] DeviceReading read(double elapsed_s) override {
    DeviceReading r = stylus_.read(elapsed_s);
    if (button) r.flags |= k_button_1;
    if (foot_off) r.pedal = 0.0;
    if (fails) throw std::runtime_error("the cable was pulled");
    return r;
  }
  void send_force(Vec3 force_n) override { stylus_.send_force(force_n); }
  void cut_force() noexcept override { stylus_.cut_force(); }
  std::atomic<bool> button{false}, foot_off{false}, fails{false};

 private:
  SimulatedStylus stylus_;
};

class LiveExamTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("CAVUM_HOME", folder_.file("").c_str(), 1);
    std::string scenario =
        read_text_file(std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml");
    scenario.insert(scenario.find("time_limit_s"),
                    "pauses = { count = 1, longest_s = 60, button = 1 }\n");
    scenario.replace(scenario.find("time_limit_s = 120"), 18,
                     "time_limit_s = " + std::to_string(limit_s_));
    write_text_file(folder_.file("task.toml"), scenario);
    write_file(
        folder_.file("block.cvt"),
        save_tooth(make_block(
            {6, 6, 5}, {{"enamel", 1.0}, {"dentin", 1.5}, {"pulp", 1.0}, {"dentin", 1.5}}, 0.05)));
    ExamOptions options;
    options.candidate = "t";
    options.position_quantum_mm = OmniModel{}.quantum_mm;
    options.tooth_file = folder_.file("block.cvt");
    setup_ = prepare_exam(folder_.file("task.toml"), options);
  }
  [[nodiscard]] std::string session() const { return folder_.file("s.cavum"); }
  testing_basics::Folder folder_;
  int limit_s_ = 60;
  std::unique_ptr<ExamSetup> setup_;
};

TEST_F(LiveExamTest, ServoAndTwinAgreeAndTheSessionVerifies) {
  Drilling device;
  LiveExam live(*setup_, session(), device, {0, 0, 0.6});
  live.start();
  ASSERT_TRUE(comes_true([&] { return live.view().ticks > 2500; }));
  EXPECT_GT(live.view().output.model_force_n, 0.0);
  live.ask_to_end();
  ASSERT_TRUE(comes_true([&] { return !live.running(); }));
  const LiveReport& report = live.finish();
  EXPECT_EQ(report.first_disagreement, -1);
  EXPECT_EQ(report.writer.error, Message());
  ASSERT_TRUE(live.exam().over());
  live.exam().close("{}");
  const VerifyReport verified = verify_session(session());
  EXPECT_TRUE(verified.verified) << testing_basics::text_of(verified.findings);
  EXPECT_EQ(verified.ticks, report.writer.ticks - report.late_ticks);
  EXPECT_GT(live.exam().state().tooth.edit_hash(), 0u);
  std::printf("%lld ticks, %lld overruns, %lld made up, %lld taken after the end\n",
              static_cast<long long>(verified.ticks), static_cast<long long>(report.servo.overruns),
              static_cast<long long>(report.servo.made_up),
              static_cast<long long>(report.late_ticks));
}

TEST_F(LiveExamTest, WhatTheStationNotesIsRecordedAndChangesNoTick) {
  Drilling device;
  LiveExam live(*setup_, session(), device, {0.3, 0, 0.6});
  live.start();
  ASSERT_TRUE(comes_true([&] { return live.view().ticks > 300; }));
  std::thread another([&live] { live.note(LockAttempt{LockTry::focus_lost}); });
  another.join();
  ASSERT_TRUE(comes_true([&] { return live.view().ticks > 700; }));
  live.ask_to_end();
  ASSERT_TRUE(comes_true([&] { return !live.running(); }));
  live.note(LockAttempt{LockTry::close_asked});  // no tick follows any more
  EXPECT_EQ(live.finish().first_disagreement, -1);
  live.exam().close("{}");
  std::vector<TimedEvent> noted;
  const SessionReader reader(session());
  for (const auto& e : reader.events())
    if (e.as<LockAttempt>() != nullptr) noted.push_back(e);
  ASSERT_EQ(noted.size(), 2u);
  EXPECT_EQ(noted[0].as<LockAttempt>()->what, LockTry::focus_lost);
  EXPECT_GT(noted[0].tick, 300);
  EXPECT_LT(noted[0].tick, 700);
  EXPECT_EQ(noted[1].tick, reader.ticks() - 1);
  EXPECT_TRUE(verify_session(session()).verified);
}

TEST_F(LiveExamTest, InAPauseTheHandpieceStandsStillWhateverTheFootDoes) {
  Drilling device;
  LiveExam live(*setup_, session(), device, {0, 0, 0.6});
  device.foot_off = true;  // a pause may begin only then
  live.start();
  ASSERT_TRUE(comes_true([&] { return live.view().ticks > 50; }));
  device.button = true;
  ASSERT_TRUE(comes_true([&] { return live.view().paused; }));
  device.button = false;
  device.foot_off = false;
  const std::int64_t at = live.view().ticks;
  ASSERT_TRUE(comes_true([&] { return live.view().ticks > at + 400; }));
  EXPECT_TRUE(live.view().paused);
  EXPECT_EQ(live.view().output.rpm, 0.0);
  EXPECT_EQ(live.view().input.pedal_q16, 0);
  device.button = true;
  ASSERT_TRUE(comes_true([&] { return !live.view().paused; }));
  device.button = false;
  ASSERT_TRUE(comes_true([&] { return live.view().output.rpm > 1000; }));
  live.ask_to_end();
  EXPECT_EQ(live.finish().first_disagreement, -1);
  live.exam().close("{}");
  EXPECT_TRUE(verify_session(session()).verified);
}

TEST_F(LiveExamTest, ADeviceThatFailsLeavesAnExamThatCanGoOn) {
  Drilling device;
  {
    LiveExam live(*setup_, session(), device, {0, 0, 0.6});
    live.start();
    ASSERT_TRUE(comes_true([&] { return live.view().ticks > 1200; }));
    device.fails = true;
    ASSERT_TRUE(comes_true([&] { return !live.running(); }));
    EXPECT_EQ(live.finish().servo.ended, (ServoStop{ServoEnd::device_failed, ServoFault::reading}));
    EXPECT_FALSE(live.exam().over());
  }
  const VerifyReport open = verify_session(session());
  EXPECT_TRUE(open.intact);
  EXPECT_FALSE(open.closed);
  const auto events = SessionReader(session()).events();
  EXPECT_TRUE(std::any_of(events.begin(), events.end(), [](const TimedEvent& e) {
    const auto* stopped = e.as<ServoStopped>();
    return stopped != nullptr && stopped->why == ServoEnd::device_failed;
  }));
  const auto resumed = Exam::resume(*setup_, session());
  EXPECT_GT(resumed->state().tick, 1200);
  resumed->end();
  resumed->close("{}");
  EXPECT_TRUE(verify_session(session()).verified);
}

class ShortLiveExamTest : public LiveExamTest {
 protected:
  void SetUp() override {
    limit_s_ = 1;
    LiveExamTest::SetUp();
  }
};

TEST_F(ShortLiveExamTest, TimeIsUpAtTheVeryTick) {
  Drilling device;
  LiveExam live(*setup_, session(), device, {0, 0, 0.6});
  live.start();
  ASSERT_TRUE(comes_true([&] { return live.view().over; }));
  live.finish();
  EXPECT_EQ(live.exam().runner_state().ticks, 1000);
  EXPECT_EQ(live.exam().runner_state().finish, Finish::time);
  live.exam().close("{}");
  EXPECT_TRUE(verify_session(session()).verified);
}

}  // namespace
}  // namespace cavum::scenarios
