#include "engine/session/session_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/physics/servo/real_time.h"
#include "engine/session/resume.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "tests/engine/session/fixture.h"
#include "tests/engine/support/faulty_device.h"

namespace cavum {
namespace {

using test::Folder;
using testing_engine::FaultyDevice;
using testing_engine::wait_ms;

/// The fixture's motion through a faulty device into a session.
struct Live {
  SessionSetup setup = test::block_setup();
  Simulation simulation = make_simulation(setup, "test");
  FaultyDevice device;
  WriterReport written;
  RealTimeReport servo_report;

  explicit Live(FaultyDevice::Fault fault)
      : device([](double t_s) { return test::motion_at(std::llround(t_s * 1000)).pose(); }, 0.9,
               std::move(fault)) {}

  /// Runs `ticks`, leaves the session open. `before_writing` delays the writer.
  void run(const std::string& path, std::int64_t ticks, std::size_t ring = 1u << 15,
           int before_writing_ms = 0, SessionWriter::Watch watch = {}) {
    TickStream stream(ring);
    Recorder recorder = Recorder::create(path, setup);
    RealTimeOptions options;
    options.max_ticks = ticks;
    RealTimeServo servo(simulation.model, simulation.state, device, stream, test::motion_at(0),
                        options);
    SessionWriter writer(stream, recorder, simulation.model.config.tick_s, std::move(watch));
    servo.start();
    wait_ms(before_writing_ms);
    writer.start();
    servo_report = servo.join();
    written = writer.finish();
  }
};

struct Kept {
  std::vector<TimedEvent> events;
  std::int64_t ticks = 0;
  template <class E>
  [[nodiscard]] std::vector<E> of() const {
    std::vector<E> list;
    for (const auto& e : events)
      if (const E* event = e.as<E>()) list.push_back(*event);
    return list;
  }
};
Kept kept(const std::string& path) {
  const SessionReader session(path);
  session.require_readable();
  EXPECT_TRUE(session.findings().empty());
  return {session.events(), session.ticks()};
}

/// The open session can be taken up, ends in the state the servo ended in, closes and verifies.
void expect_resumes_and_verifies(const std::string& path, const Live& live) {
  ResumedSession resumed = resume_session(path);
  EXPECT_EQ(state_hash(resumed.simulation.state), state_hash(live.simulation.state));
  test::drill(resumed.simulation, resumed.recorder, resumed.ticks, 100);
  resumed.recorder.close(save_tooth(drilled_tooth(resumed.simulation)), "{}");
  const VerifyReport report = verify_session(path);
  EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
}

TEST(SessionWriter, AQuietRunIsRecordedTickByTickAndVerifies) {
  const Folder folder;
  const std::string path = folder.file("live.cavum");
  Live live({});
  std::int64_t watched = 0, watched_leaves = 0;
  live.run(path, 1500, 1u << 15, 0,
           [&](const ServoTick& tick, std::span<const RemovedLeaf> removed) {
             EXPECT_EQ(tick.tick, watched++);
             EXPECT_EQ(tick.output.removed_count, removed.size());
             watched_leaves += static_cast<std::int64_t>(removed.size());
             return true;
           });
  EXPECT_EQ(live.written.error, Message());
  EXPECT_EQ(live.written.ticks, 1500);
  EXPECT_EQ(watched, 1500);
  EXPECT_GT(watched_leaves, 100) << "the motion must drill, or the test shows little";
  const Kept k = kept(path);
  EXPECT_EQ(k.ticks, 1500);
  ASSERT_EQ(k.of<ServoStopped>().size(), 1u);
  EXPECT_EQ(k.of<ServoStopped>().front().why, ServoEnd::ticks);
  expect_resumes_and_verifies(path, live);
}

TEST(SessionWriter, OverrunsAreEventsAndNoneIsHidden) {
  const Folder folder;
  const std::string path = folder.file("late.cavum");
  Live live([](std::int64_t n, DeviceReading&) {
    if (n % 100 == 99) wait_ms(5);
  });
  live.run(path, 1500);
  const Kept k = kept(path);
  std::int64_t told = 0;
  double worst = 0;
  for (const auto& e : k.of<Overruns>()) {
    told += e.count;
    worst = std::max(worst, e.worst_late_ms);
  }
  EXPECT_EQ(told, live.servo_report.overruns);
  EXPECT_GE(told, 30);
  EXPECT_GE(worst, 3.0);
  expect_resumes_and_verifies(path, live);
}

TEST(SessionWriter, NaNIsAnEventAndTheSessionGoesOn) {
  const Folder folder;
  const std::string path = folder.file("nan.cavum");
  Live live([](std::int64_t n, DeviceReading& r) {
    if (n >= 400 && n < 600) {
      r.pose.tip_mm.x = NAN;
      r.pedal = NAN;
    }
  });
  live.run(path, 1000);
  const Kept k = kept(path);
  EXPECT_EQ(k.ticks, 1000);
  bool fault = false;
  for (const auto& e : k.of<StylusSilent>()) fault = fault || e.fault;
  EXPECT_TRUE(fault);
  EXPECT_GE(k.of<StylusBack>().size(), 1u);
  EXPECT_GE(k.of<PedalLost>().size(), 1u);
  EXPECT_GE(k.of<PedalBack>().size(), 1u);
  expect_resumes_and_verifies(path, live);
}

TEST(SessionWriter, AThrowingDeviceLeavesAnOpenSessionThatSaysWhy) {
  const Folder folder;
  const std::string path = folder.file("thrown.cavum");
  Live live([](std::int64_t n, DeviceReading&) {
    if (n == 700) throw std::runtime_error("transfer failed: \"pipe\" \xff");
  });
  live.run(path, 5000);
  EXPECT_EQ(live.written.error, Message());
  EXPECT_EQ(live.device.sent.back().force_n, Vec3{});
  const Kept k = kept(path);
  EXPECT_EQ(k.ticks, live.servo_report.ticks);
  ASSERT_EQ(k.of<ServoStopped>().size(), 1u);
  EXPECT_EQ(k.of<ServoStopped>().front().why, ServoEnd::device_failed);
  EXPECT_EQ(k.of<ServoStopped>().front().fault, ServoFault::reading);
  expect_resumes_and_verifies(path, live);
}

TEST(SessionWriter, AStalledWriterLosesNoTickAndTheGapIsTold) {
  const Folder folder;
  const std::string path = folder.file("stalled.cavum");
  Live live({});
  live.run(path, 600, 256, 400);
  // On a machine that is held up itself some periods are given up as late before the stream is
  // found full.
  EXPECT_GE(live.servo_report.skipped_full + live.servo_report.skipped_late, 50);
  EXPECT_GE(live.servo_report.skipped_full, 1);
  EXPECT_EQ(live.written.ticks, 600);
  EXPECT_GE(live.written.most_waiting, 250);
  const Kept k = kept(path);
  EXPECT_EQ(k.ticks, 600);
  std::int64_t told = 0;
  for (const auto& e : k.of<ServoGap>()) told += e.periods;
  EXPECT_EQ(told, live.servo_report.skipped_full + live.servo_report.skipped_late);
  expect_resumes_and_verifies(path, live);
}

TEST(SessionWriter, AWatchThatThrowsIsReportedAndTheTicksAreKept) {
  const Folder folder;
  const std::string path = folder.file("watch.cavum");
  Live live({});
  int calls = 0;
  live.run(path, 300, 1u << 15, 0, [&](const ServoTick& tick, std::span<const RemovedLeaf>) {
    ++calls;
    if (tick.tick == 100) throw std::runtime_error("runner broke");
    return true;
  });
  EXPECT_TRUE(testing_basics::tells(live.written.error, "runner broke"));
  EXPECT_EQ(calls, 101);
  EXPECT_EQ(kept(path).ticks, 300);
}

}  // namespace
}  // namespace cavum
