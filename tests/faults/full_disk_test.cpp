// A disk that is full: writes beyond a limit fail (RLIMIT_FSIZE). The recorder says so, keeps what
// it has, and goes on without a loss once there is room.
#include "tests/faults/full_disk.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>

#include "engine/base/error.h"
#include "engine/session/resume.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

using test::FullDisk;

class FullDiskTest : public ::testing::Test {
 protected:
  /// One tick; true when the recorder complained.
  bool drill_tick(std::int64_t tick) {
    const TickInput input = test::motion_at(tick);
    const TickRecord record = make_tick_record(step(simulation_.model, simulation_.state, input));
    try {
      recorder_.append(input, record, simulation_.state.removed, state_hash(simulation_.state));
      return false;
    } catch (const DatabaseError& e) {
      complaint_ = e.refusal().fault;
      return true;
    }
  }
  Bytes tooth() { return save_tooth(drilled_tooth(simulation_)); }

  test::Folder folder_;
  std::string path_ = folder_.file("exam.cavum");
  SessionSetup setup_ = test::block_setup();
  Simulation simulation_ = make_simulation(setup_, "test");
  Recorder recorder_ = Recorder::create(path_, setup_);
  DiskFault complaint_ = DiskFault::other;
};

TEST_F(FullDiskTest, IsReportedAndLosesNothingOnceThereIsRoom) {
  for (std::int64_t tick = 0; tick < 1500; ++tick) ASSERT_FALSE(drill_tick(tick));
  int complaints = 0;
  {
    const FullDisk full(std::filesystem::file_size(path_ + "-wal") + 1500);
    for (std::int64_t tick = 1500; tick < 4600; ++tick) complaints += drill_tick(tick);
  }
  EXPECT_EQ(complaints, 3) << "once for each second that could not be written";
  EXPECT_TRUE(complaint_ == DiskFault::full || complaint_ == DiskFault::input_output)
      << k_disk_faults[static_cast<std::size_t>(complaint_)];
  EXPECT_EQ(recorder_.ticks(), 4600);
  EXPECT_EQ(recorder_.ticks_on_disk(), 1000);
  EXPECT_EQ(SessionReader(path_).ticks(), 1000);
  recorder_.add_event(4600, TimeUp{});
  for (std::int64_t tick = 4600; tick < 5200; ++tick) ASSERT_FALSE(drill_tick(tick));
  EXPECT_EQ(recorder_.ticks_on_disk(), 5000)
      << "the seconds that waited were written with the next one";
  recorder_.close(tooth(), "{}");

  const VerifyReport report = verify_session(path_);
  EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
  const auto inputs = SessionReader(path_).inputs();
  ASSERT_EQ(inputs.size(), 5200u);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    ASSERT_EQ(inputs[i], test::motion_at(static_cast<std::int64_t>(i)));
  EXPECT_EQ(SessionReader(path_).events().size(), 1u);
}

TEST_F(FullDiskTest, GoesOnAtAnotherPlaceWithAllThatWaited) {
  const std::string elsewhere = folder_.file("elsewhere.cavum");
  for (std::int64_t tick = 0; tick < 6500; ++tick) ASSERT_FALSE(drill_tick(tick));
  {
    const FullDisk full(std::filesystem::file_size(path_ + "-wal") + 1500);
    for (std::int64_t tick = 6500; tick < 8300; ++tick) static_cast<void>(drill_tick(tick));
    ASSERT_EQ(recorder_.ticks_on_disk(), 6000);
    EXPECT_THROW(recorder_.move_to(path_, {DiskFault::full}), Error)
        << "what is there is never overwritten";
    EXPECT_THROW(recorder_.move_to(folder_.file("no/such/folder.cavum"), {DiskFault::full}), Error);
    EXPECT_THROW(recorder_.move_to(elsewhere, {DiskFault::full}), Error) << "it is as full there";
    EXPECT_EQ(recorder_.path(), path_);
    EXPECT_FALSE(std::filesystem::exists(elsewhere));
  }
  recorder_.move_to(elsewhere, {DiskFault::full});  // where there is room
  EXPECT_EQ(recorder_.path(), elsewhere);
  EXPECT_EQ(recorder_.ticks_on_disk(), 8300);
  for (std::int64_t tick = 8300; tick < 8600; ++tick) ASSERT_FALSE(drill_tick(tick));
  recorder_.close(tooth(), "{}");
  const VerifyReport report = verify_session(elsewhere);
  EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
  EXPECT_EQ(report.ticks_replayed, 8600);
  const SessionReader moved(elsewhere);
  const auto inputs = moved.inputs();
  ASSERT_EQ(inputs.size(), 8600u);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    ASSERT_EQ(inputs[i], test::motion_at(static_cast<std::int64_t>(i)));
  ASSERT_EQ(moved.events().size(), 1u);
  EXPECT_EQ(moved.events()[0].tick, 8300);
  ASSERT_NE(moved.event_rows()[0].as<RecordingMoved>(), nullptr);
  EXPECT_EQ(moved.event_rows()[0].as<RecordingMoved>()->ticks, 6000);
  EXPECT_FALSE(std::filesystem::exists(elsewhere + "-wal"));

  const VerifyReport first = verify_session(path_);
  EXPECT_TRUE(first.intact) << "what was committed before stays true where it was";
  EXPECT_FALSE(first.closed);
  EXPECT_EQ(first.ticks, 6000);
}

TEST(FullDisk, AnExamIsResumedOnItAndSavedElsewhere) {
  const test::Folder folder;
  const std::string path = folder.file("exam.cavum"), elsewhere = folder.file("elsewhere.cavum");
  const SessionSetup setup = test::block_setup();
  Simulation simulation = make_simulation(setup, "test");
  const auto drill = [&](Recorder& recorder, std::int64_t from, std::int64_t to) {
    int complaints = 0;
    for (std::int64_t tick = from; tick < to; ++tick) {
      const TickInput input = test::motion_at(tick);
      const TickRecord record = make_tick_record(step(simulation.model, simulation.state, input));
      try {
        recorder.append(input, record, simulation.state.removed, state_hash(simulation.state));
      } catch (const DatabaseError&) {
        ++complaints;
      }
    }
    return complaints;
  };
  {
    Recorder recorder = Recorder::create(path, setup);
    ASSERT_EQ(drill(recorder, 0, 2000), 0);
  }
  std::optional<ResumedSession> resumed;
  {
    const FullDisk full(1024);
    resumed.emplace(resume_session(path));
    EXPECT_EQ(drill(resumed->recorder, 2000, 3100), 1)
        << "the candidate is told with the first second";
  }
  resumed->recorder.move_to(elsewhere, {DiskFault::full});
  EXPECT_EQ(resumed->recorder.ticks_on_disk(), 3100);
  resumed->recorder.close(save_tooth(drilled_tooth(simulation)), "{}");
  const VerifyReport report = verify_session(elsewhere);
  EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
  EXPECT_EQ(report.ticks, 3100);
  const auto events = SessionReader(elsewhere).events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_NE(events[0].as<RecordingGap>(), nullptr);
  EXPECT_EQ(events[0].tick, 2000);
  EXPECT_NE(events[1].as<RecordingMoved>(), nullptr);
}

TEST_F(FullDiskTest, ASealThatDoesNotFitIsSetElsewhere) {
  const std::string elsewhere = folder_.file("elsewhere.cavum");
  for (std::int64_t tick = 0; tick < 5200; ++tick) ASSERT_FALSE(drill_tick(tick));
  const Bytes last = tooth();
  {
    const FullDisk full(std::filesystem::file_size(path_ + "-wal") + 1500);
    EXPECT_THROW(recorder_.close(last, R"({"verdict":"pass"})"), DatabaseError);
  }
  recorder_.move_to(elsewhere, {DiskFault::full});
  recorder_.close(last, R"({"verdict":"pass"})");
  const VerifyReport report = verify_session(elsewhere);
  EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
  EXPECT_EQ(report.ticks, 5200);
  EXPECT_EQ(SessionReader(elsewhere).result_json(), R"({"verdict":"pass"})");
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
  for (std::uintmax_t room = 0; !close(std::filesystem::file_size(path_) / 2 + room);
       room += 1024) {
    ++failed;
    sealed_in_the_log += verify_session(path_).verified;
  }
  EXPECT_GT(sealed_in_the_log, 0)
      << "closed on disk, but not yet a single file: must read as closed";
  EXPECT_GT(failed, 3);
  EXPECT_FALSE(std::filesystem::exists(path_ + "-wal"));
  const VerifyReport report = verify_session(path_);
  EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
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
