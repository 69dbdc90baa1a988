#include "engine/session/clock_check.h"

#include <gtest/gtest.h>

#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

class ClockCheck : public ::testing::Test {
 protected:
  void SetUp() override {
    test::make_closed_session(path_, 6000);
    // what a hand in real time would have left: each second ends a second after the one before
    test::tamper(
        path_,
        "UPDATE meta SET value = '0' WHERE key IN ('created_monotonic_ns', 'created_boot_ns', 'created_utc_ns'); "
        "UPDATE chunk SET monotonic_ns = (seq + 1) * 1000000000, boot_ns = (seq + 1) * 1000000000, utc_ns = (seq + 1) * 1000000000");
  }
  std::vector<ClockRemark> after(const std::string& sql) {
    if (!sql.empty()) test::tamper(path_, sql);
    return check_clocks(SessionReader(path_));
  }
  void expect_one(const std::vector<ClockRemark>& remarks, std::int64_t tick, DamageKind kind,
                  double s) {
    ASSERT_EQ(remarks.size(), 1u) << (remarks.size() > 1 ? remarks[1].message() : Message());
    EXPECT_EQ(remarks[0].first_tick, tick);
    EXPECT_EQ(remarks[0].kind, kind);
    EXPECT_NEAR(testing_basics::figures_in(remarks[0].message()).back(), s, 0.05);
  }
  test::Folder folder_;
  std::string path_ = folder_.file("exam.cavum");
};

TEST_F(ClockCheck, AnExamInRealTimeIsNotRemarkedOn) { EXPECT_TRUE(after("").empty()); }
TEST_F(ClockCheck, ASuspendIsNamedWithItsLength) {
  expect_one(
      after(
          "UPDATE chunk SET boot_ns = boot_ns + 5000000000, utc_ns = utc_ns + 5000000000 WHERE seq >= 2"),
      2000, DamageKind::clock_slept, 5);
}
TEST_F(ClockCheck, SlowMotionIsNamedAndLongerIsDoubtful) {
  const auto slow = [](const char* by) {
    const std::string more = std::string(" + ") + by;
    return "UPDATE chunk SET monotonic_ns = monotonic_ns" + more + ", boot_ns = boot_ns" + more +
           ", utc_ns = utc_ns" + more + " WHERE seq >= 4";
  };
  const auto once = after(slow("1500000000"));
  expect_one(once, 4000, DamageKind::clock_slow, 2.5);
  EXPECT_FALSE(once[0].doubtful) << "a station may be slow for a moment";
  const auto twice = after(slow("1500000000"));
  ASSERT_EQ(twice.size(), 2u);
  EXPECT_EQ(twice[1].kind, DamageKind::clock_lost);
  EXPECT_NEAR(testing_basics::figures_in(twice[1].message()).back(), 3, 0.05);
  EXPECT_TRUE(twice[1].doubtful);
}
TEST_F(ClockCheck, AWallClockThatWasSetIsNamed) {
  expect_one(after("UPDATE chunk SET utc_ns = utc_ns - 3600000000000 WHERE seq >= 1"), 1000,
             DamageKind::clock_put_back, 3600);
}
TEST_F(ClockCheck, ARecordingFasterThanTimeIsDoubtful) {
  const auto remarks = after(
      "UPDATE chunk SET monotonic_ns = monotonic_ns / 10, boot_ns = boot_ns / 10, utc_ns = utc_ns / 10");
  expect_one(remarks, 1000, DamageKind::clock_fast, 5.4);
  EXPECT_TRUE(remarks[0].doubtful);
}
TEST_F(ClockCheck, AFastEndOfAnExamThatBeganInRealTimeIsDoubtful) {
  const auto remarks = after(
      "UPDATE chunk SET monotonic_ns = 3000000000, boot_ns = 3000000000, utc_ns = 3000000000 WHERE seq >= 3");
  expect_one(remarks, 4000, DamageKind::clock_fast, 3);
  EXPECT_TRUE(remarks[0].doubtful);
}
TEST_F(ClockCheck, AWriterThatWaitedForItsDiskIsNot) {
  // the fourth second is written late, those after it at once
  EXPECT_TRUE(
      after(
          "UPDATE chunk SET monotonic_ns = 5400000000, boot_ns = 5400000000, utc_ns = 5400000000 WHERE seq = 4")
          .empty());
}
TEST_F(ClockCheck, TimeThatTheServoOwnsUpToIsAccountedFor) {
  const std::string path = folder_.file("stopped.cavum");
  {
    const SessionSetup setup = test::block_setup();
    Simulation simulation = make_simulation(setup, "test");
    std::int64_t tick = 0, lost_ms = 0;
    Recorder recorder = Recorder::create(path, setup, [&] {
      const std::int64_t ns = (tick + lost_ms) * 1'000'000;
      return Clocks{ns, ns, ns};
    });
    for (; tick < 3000; ++tick) {
      if (tick == 1500) {
        lost_ms = 4000;
        recorder.add_event(tick, ServoGap{4000, 1, 1500});
      }
      test::drill(simulation, recorder, tick, 1);
    }
    recorder.close(save_tooth(drilled_tooth(simulation)), "{}");
  }
  const SessionReader session(path);
  EXPECT_NEAR(admitted_lost_s(session), 4.0, 1e-9);
  for (const auto& r : check_clocks(session)) EXPECT_FALSE(r.doubtful) << r.message();
}

}  // namespace
}  // namespace cavum
