// A disk that is full: writes beyond a limit fail (RLIMIT_FSIZE). The recorder says so, keeps what it has,
// and goes on without a loss once there is room.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>

#include "engine/base/error.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

/// No file may grow beyond `bytes` while this lives.
class FullDisk {
 public:
  explicit FullDisk(std::uintmax_t bytes) {
    old_handler_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &old_);
    rlimit now = old_;
    now.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit old_{};
  void (*old_handler_)(int) = nullptr;
};

class FullDiskTest : public testing::Test {
 protected:
  /// One tick; true when the recorder complained.
  bool drill_tick(std::int64_t tick) {
    const TickInput input = test::motion_at(tick);
    const TickRecord record = make_tick_record(step(simulation_.model, simulation_.state, input));
    try {
      recorder_.append(input, record, simulation_.state.removed, state_hash(simulation_.state));
      return false;
    } catch (const Error& e) {
      complaint_ = e.what();
      return true;
    }
  }
  Bytes tooth() { return save_tooth(drilled_tooth(simulation_)); }

  test::Folder folder_;
  std::string path_ = folder_.file("exam.cavum");
  SessionSetup setup_ = test::block_setup();
  Simulation simulation_ = make_simulation(setup_, "test");
  Recorder recorder_ = Recorder::create(path_, setup_);
  std::string complaint_;
};

TEST_F(FullDiskTest, IsReportedAndLosesNothingOnceThereIsRoom) {
  for (std::int64_t tick = 0; tick < 1500; ++tick) ASSERT_FALSE(drill_tick(tick));
  int complaints = 0;
  {
    const FullDisk full(std::filesystem::file_size(path_ + "-wal") + 1500);
    for (std::int64_t tick = 1500; tick < 4600; ++tick) complaints += drill_tick(tick);
  }
  EXPECT_EQ(complaints, 3) << "once for each second that could not be written";
  EXPECT_NE(complaint_.find("room on the disk"), std::string::npos) << complaint_;
  EXPECT_EQ(recorder_.ticks(), 4600);
  EXPECT_EQ(recorder_.ticks_on_disk(), 1000);
  EXPECT_EQ(SessionReader(path_).ticks(), 1000);
  recorder_.add_event(4600, "note", "{}");
  for (std::int64_t tick = 4600; tick < 5200; ++tick) ASSERT_FALSE(drill_tick(tick));
  EXPECT_EQ(recorder_.ticks_on_disk(), 5000) << "the seconds that waited were written with the next one";
  recorder_.close(tooth(), "{}");

  const VerifyReport report = verify_session(path_);
  EXPECT_TRUE(report.verified) << (report.findings.empty() ? "" : report.findings.front());
  const auto inputs = SessionReader(path_).inputs();
  ASSERT_EQ(inputs.size(), 5200u);
  for (std::size_t i = 0; i < inputs.size(); ++i) ASSERT_EQ(inputs[i], test::motion_at(static_cast<std::int64_t>(i)));
  EXPECT_EQ(SessionReader(path_).events().size(), 1u);
}

TEST_F(FullDiskTest, WhileClosingCanBeRepeated) {
  for (std::int64_t tick = 0; tick < 1300; ++tick) ASSERT_FALSE(drill_tick(tick));
  const Bytes last = tooth();
  const auto close = [&](std::uintmax_t largest_file) {
    const FullDisk full(largest_file);
    try {
      recorder_.close(last, R"({"verdict":"pass"})");
      return true;
    } catch (const Error&) {
      return false;
    }
  };
  int failed = 0, sealed_in_the_log = 0;
  // ever a little more room: it fails at every stage of closing in turn
  for (std::uintmax_t room = 0; !close(std::filesystem::file_size(path_) / 2 + room); room += 1024) {
    ++failed;
    sealed_in_the_log += verify_session(path_).verified;
  }
  EXPECT_GT(sealed_in_the_log, 0) << "closed on disk, but not yet a single file: must read as closed";
  EXPECT_GT(failed, 3);
  EXPECT_FALSE(std::filesystem::exists(path_ + "-wal"));
  const VerifyReport report = verify_session(path_);
  EXPECT_TRUE(report.verified) << (report.findings.empty() ? "" : report.findings.front());
  EXPECT_EQ(report.ticks, 1300);
}

TEST(FullDiskAtStart, LeavesNoFileBehind) {
  const test::Folder folder;
  const std::string path = folder.file("exam.cavum");
  (void)load_station_key(station_key_path());
  const SessionSetup setup = test::block_setup();
  {
    const FullDisk full(4096);
    EXPECT_THROW((void)Recorder::create(path, setup), Error);
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(path + ".new"));
  EXPECT_NO_THROW((void)Recorder::create(path, setup));
}

}  // namespace
}  // namespace cavum
