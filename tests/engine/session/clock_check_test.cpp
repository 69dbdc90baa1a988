#include "engine/session/clock_check.h"

#include <gtest/gtest.h>

#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

class ClockCheck : public testing::Test {
 protected:
  void SetUp() override {
    test::make_closed_session(path_, 6000);
    // what a hand in real time would have left: each second ends a second after the one before
    test::tamper(path_,
                 "UPDATE meta SET value = '0' WHERE key IN ('created_monotonic_ns', 'created_boot_ns', 'created_utc_ns'); "
                 "UPDATE chunk SET monotonic_ns = (seq + 1) * 1000000000, boot_ns = (seq + 1) * 1000000000, utc_ns = (seq + 1) * 1000000000");
  }
  std::vector<ClockRemark> after(const std::string& sql) {
    if (!sql.empty()) test::tamper(path_, sql);
    return check_clocks(SessionReader(path_));
  }
  void expect_one(const std::vector<ClockRemark>& remarks, std::int64_t tick, const std::string& words) {
    ASSERT_EQ(remarks.size(), 1u) << (remarks.size() > 1 ? remarks[1].what : "");
    EXPECT_EQ(remarks[0].first_tick, tick);
    EXPECT_NE(remarks[0].what.find(words), std::string::npos) << remarks[0].what;
  }
  test::Folder folder_;
  std::string path_ = folder_.file("exam.cavum");
};

TEST_F(ClockCheck, AnExamInRealTimeIsNotRemarkedOn) { EXPECT_TRUE(after("").empty()); }
TEST_F(ClockCheck, ASuspendIsNamedWithItsLength) {
  expect_one(after("UPDATE chunk SET boot_ns = boot_ns + 5000000000, utc_ns = utc_ns + 5000000000 WHERE seq >= 2"), 2000, "slept for 5.0 s");
}
TEST_F(ClockCheck, SlowMotionIsNamed) {
  expect_one(
      after("UPDATE chunk SET monotonic_ns = monotonic_ns + 3000000000, boot_ns = boot_ns + 3000000000, utc_ns = utc_ns + 3000000000 WHERE seq >= 4"),
      4000, "1.0 s of the exam took 4.0 s");
}
TEST_F(ClockCheck, AWallClockThatWasSetIsNamed) {
  expect_one(after("UPDATE chunk SET utc_ns = utc_ns - 3600000000000 WHERE seq >= 1"), 1000, "set back by 3600.0 s");
}
TEST_F(ClockCheck, ARecordingFasterThanTimeIsSimulated) {
  expect_one(after("UPDATE chunk SET monotonic_ns = monotonic_ns / 10, boot_ns = boot_ns / 10, utc_ns = utc_ns / 10"), 0,
             "6.0 s of the exam were recorded in 0.6 s");
}

}  // namespace
}  // namespace cavum
