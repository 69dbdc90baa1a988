#include "engine/physics/servo/real_time.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "engine/base/order.h"
#include "engine/device/simulated_stylus.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/closed_loop.h"
#include "tests/engine/support/faulty_device.h"

namespace cavum {
namespace {

using namespace testing_engine;

/// Presses 0.8 mm deep, which is 0.64 N, from the first tick on.
Pose pressing(double t_s) { return {{0, 0, 0.1 - std::min(0.9, 20 * t_s)}, {}}; }

/// Servo, stream and a device with a fault; emptied after the run.
struct Live {
  Rig rig{
      make_cube(4, "dentin", 0.1), {shipped_bur("round-1.0")}, hard_model(0.8, 0.012), {0, 0, 0.1}};
  TickStream stream;
  FaultyDevice device;
  RealTimeOptions options;
  RealTimeReport report;
  std::vector<ServoTick> ticks;

  explicit Live(FaultyDevice::Fault fault, std::size_t ring = 1u << 15)
      : stream(ring), device(pressing, 0.0, std::move(fault)) {}
  void go(std::int64_t max_ticks) {
    options.max_ticks = max_ticks;
    RealTimeServo servo(rig.model, rig.state, device, stream, {}, options);
    servo.start();
    report = servo.join();
    empty();
  }
  void empty() {
    ServoTick tick;
    std::vector<RemovedLeaf> removed;
    while (stream.pop(tick, removed)) ticks.push_back(tick);
  }
};

constexpr double k_patience_s =
    5.0;  // a shared machine has held up a thread for more than a second

TEST(RealTime, KeepsThePaceOfTheClockAndTellsWhatItGot) {
  Live run({});
  const std::int64_t start = monotonic_ns();
  run.go(500);
  const double seconds = static_cast<double>(monotonic_ns() - start) * 1e-9;
  EXPECT_EQ(run.report.ticks, 500);
  EXPECT_EQ(run.report.ended.why, ServoEnd::ticks);
  EXPECT_EQ(run.report.lateness.ticks, 500);
  EXPECT_GE(seconds, 0.499) << "never faster than real time";
  EXPECT_LT(seconds,
            0.499 + static_cast<double>(run.report.lateness.worst_ns) * 1e-9 + k_patience_s);
  EXPECT_TRUE(run.report.fifo.asked && run.report.memory.asked);
  std::printf("fifo: %s, memory: %s, late mean %.1f worst %.1f us, %lld overruns\n",
              run.report.fifo.granted() ? "yes" : std::strerror(run.report.fifo.error),
              run.report.memory.granted() ? "locked" : std::strerror(run.report.memory.error),
              run.report.lateness.mean_us(), run.report.lateness.worst_us(),
              static_cast<long long>(run.report.overruns));
  ASSERT_EQ(run.ticks.size(), 500u);
  for (std::size_t i = 0; i < run.ticks.size(); ++i)
    ASSERT_EQ(run.ticks[i].tick, static_cast<std::int64_t>(i));
  EXPECT_EQ(run.device.sent.back().force_n, Vec3{}) << "zero force at the end";
}

TEST(RealTime, GivesTheSameBitsAsTheSameInputsWithoutAClock) {
  Live run({});
  run.go(400);
  Rig again{
      make_cube(4, "dentin", 0.1), {shipped_bur("round-1.0")}, hard_model(0.8, 0.012), {0, 0, 0.1}};
  for (const auto& t : run.ticks) {
    ASSERT_EQ(make_tick_record(step(again.model, again.state, t.input)), make_tick_record(t.output))
        << t.tick;
    ASSERT_EQ(state_hash(again.state), t.state_hash) << t.tick;
  }
  EXPECT_NEAR(length(run.ticks.back().output.rendered_force_n), 0.64, 0.02)
      << "it must have pressed";
}

TEST(RealTime, ASilentStylusFadesWithin10Milliseconds) {
  Live run([](std::int64_t n, DeviceReading& r) {
    if (n >= 200) r.flags = k_pedal_fresh;
  });
  run.go(400);
  ASSERT_GE(run.device.sent.size(), 240u);
  std::int64_t last_fresh = -1, zero_at = -1;
  for (const auto& t : run.ticks)
    if ((t.input.flags & k_stylus_fresh) != 0) last_fresh = t.tick;
  for (const auto& t : run.ticks)
    if (t.tick > last_fresh && zero_at < 0 && length(t.output.rendered_force_n) == 0.0)
      zero_at = t.tick;
  ASSERT_GT(zero_at, last_fresh);
  EXPECT_LE(zero_at - last_fresh, 10) << "a tick is a millisecond";
  EXPECT_GT(zero_at - last_fresh, 5) << "the watchdog waits 5 ms, then fades";
  for (const auto& s : run.device.sent)
    if (s.read >= 212) {
      ASSERT_EQ(s.force_n, Vec3{}) << s.read;
    }
}

TEST(RealTime, NaNFromTheDeviceEndsWithZeroForceAndTheServoLives) {
  Live run([](std::int64_t n, DeviceReading& r) {
    if (n >= 200 && n < 300) {
      r.pose.tip_mm.y = NAN;
      r.pose.rotation.w = INFINITY;
      r.pedal = NAN;
    }
  });
  run.go(600);
  EXPECT_EQ(run.report.ended.why, ServoEnd::ticks);
  for (const auto& s : run.device.sent) {
    ASSERT_TRUE(is_finite(s.force_n));
    if (s.read > 212 && s.read < 300) {
      ASSERT_EQ(s.force_n, Vec3{}) << s.read;
    }
  }
  int faults = 0;
  for (const auto& t : run.ticks) faults += (t.input.flags & k_stylus_fault) != 0;
  EXPECT_GE(faults, 50);
  EXPECT_NEAR(length(run.ticks.back().output.rendered_force_n), 0.64, 0.02)
      << "a device that recovers is felt again";
}

TEST(RealTime, WhatTheDeviceThrowsStopsTheServoWithZeroForce) {
  for (const int kind : {0, 1}) {
    Live run([kind](std::int64_t n, DeviceReading&) {
      if (n != 250) return;
      if (kind == 0) throw std::runtime_error("the cable came out");
      throw 42;
    });
    run.go(1000);
    EXPECT_EQ(run.report.ended.why, ServoEnd::device_failed);
    EXPECT_FALSE(run.report.failure.empty());
    if (kind == 0) {
      EXPECT_EQ(run.report.failure, Message(cavum::Name{"the cable came out"}));
    }
    EXPECT_GT(length(run.device.sent[run.device.sent.size() - 2].force_n), 0.5);
    EXPECT_EQ(run.device.sent.back().force_n, Vec3{});
    EXPECT_TRUE(run.stream.closed());
    EXPECT_EQ(run.stream.stop(), (ServoStop{ServoEnd::device_failed, ServoFault::reading}));
    EXPECT_EQ(static_cast<std::int64_t>(run.ticks.size()), run.report.ticks);
  }
}

TEST(RealTime, ADeviceThatSleepsIsSeenAsOverrunsAndItsTimeIsMadeUp) {
  constexpr std::int64_t k_sleeps = 20, k_first = 25, k_apart = 10,
                         k_awake = k_first + k_sleeps * k_apart;
  // How far the readings lie behind the clock is also how late this machine wakes a thread. The
  // least of many is neither that nor a single sleep: it grows only by time that was lost for good.
  std::int64_t start_ns = 0, early_ns = INT64_MAX, late_ns = INT64_MAX;
  const FaultyDevice* device = nullptr;
  Live run([&](std::int64_t n, DeviceReading&) {
    const std::int64_t now = monotonic_ns();
    if (n == 0) start_ns = now;
    const std::int64_t behind_ns = now - start_ns - std::llround(device->time_s() * 1e9);
    if (n < k_first) early_ns = std::min(early_ns, behind_ns);
    if (n >= k_awake) late_ns = std::min(late_ns, behind_ns);
    if (n >= k_first && n < k_awake && n % k_apart == 0) wait_ms(5);
  });
  device = &run.device;
  run.go(900);
  EXPECT_EQ(run.report.ticks, 900);
  EXPECT_GE(run.report.overruns, 3 * k_sleeps)
      << "5 ms late: the ticks at 4, 3 and 2 ms were missed";
  EXPECT_GE(run.report.made_up + run.report.skipped_late, 3 * k_sleeps);
  EXPECT_GE(static_cast<double>(run.report.ticks + run.report.skipped_late),
            run.device.time_s() * 1e3 - 0.5)
      << "a period that passed has no tick";
  ASSERT_GE(run.device.reads, k_awake + 50) << "too few readings after the sleeps to tell";
  EXPECT_LE(static_cast<double>(late_ns - early_ns) * 1e-6, 20.0)
      << "ms were lost: 20 sleeps that nobody makes up for would be 80";
  std::int64_t late = 0;
  for (const auto& t : run.ticks) late += t.late_ns > 1'000'000;
  EXPECT_EQ(late, run.report.overruns) << "the ticks handed on tell the same";
}

TEST(RealTime, AHungDeviceLosesItsForceByTheGuard) {
  std::atomic<bool> cut_while_hung{false};
  FaultyDevice* seen = nullptr;
  Live run([&](std::int64_t n, DeviceReading&) {
    if (n != 200) return;
    wait_ms(80);
    cut_while_hung = seen->is_cut.load();
  });
  seen = &run.device;
  run.go(400);
  EXPECT_TRUE(cut_while_hung);
  EXPECT_GE(run.report.guard_cuts, 1);
  std::printf("force cut %.2f ms after it was sent\n",
              static_cast<double>(run.device.cut_after_ns) * 1e-6);
  const auto after = std::find_if(run.device.sent.begin(), run.device.sent.end(),
                                  [](const auto& s) { return s.read == 200; });
  ASSERT_NE(after, run.device.sent.end());
  EXPECT_LE(length(after->force_n), 0.7 + 1e-9) << "it comes back by the slew limit, not by a blow";
}

TEST(RealTime, WithoutRoomInTheStreamNoStepIsTakenAndTheForceIsZero) {
  Live run({}, 128);
  RealTimeServo servo(run.rig.model, run.rig.state, run.device, run.stream, {}, run.options);
  servo.start();
  while (run.stream.waiting() < 128) wait_ms(1);
  wait_ms(50);
  std::vector<ServoTick>& ticks = run.ticks;
  run.empty();  // as a writer that wakes up again
  while (run.stream.waiting() < 40) wait_ms(1);
  servo.ask_to_stop();
  run.report = servo.join();
  run.empty();
  EXPECT_EQ(run.report.ended.why, ServoEnd::asked);
  EXPECT_GE(run.report.skipped_full, 30);
  ASSERT_EQ(static_cast<std::int64_t>(ticks.size()), run.report.ticks);
  std::int64_t told = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    ASSERT_EQ(ticks[i].tick, static_cast<std::int64_t>(i)) << "every step taken was handed over";
    told += ticks[i].skipped_periods;
  }
  EXPECT_EQ(told, run.report.skipped_full) << "and what was left out is told";
  for (const auto& s : run.device.sent)
    if (s.read > 140 && s.read < 160) {
      EXPECT_EQ(s.force_n, Vec3{});
    }
}

TEST(RealTime, ALongPauseIsMadeUpForInPartAndTheRestIsCounted) {
  Live run([](std::int64_t n, DeviceReading&) {
    if (n == 100) wait_ms(200);
  });
  run.options.most_made_up = 50;
  run.go(400);
  EXPECT_GE(run.report.skipped_late, 100);
  EXPECT_GE(run.report.made_up, 50);
  std::int64_t told = 0;
  for (const auto& t : run.ticks) told += t.skipped_periods;
  EXPECT_EQ(told, run.report.skipped_late);
}

TEST(RealTime, WhereStepsTakeLongerThanAPeriodTheDeviceIsStillReadAndTheRestIsCounted) {
  Live run({});
  const double tick_s = 1e-8;  // no computer keeps that
  run.rig = Rig(make_cube(4, "dentin", 0.1), {shipped_bur("round-1.0")}, hard_model(0.8, 0.012),
                {0, 0, 0.1}, tick_s);
  run.options.most_made_up = 1 << 30;  // so that only the time spent on it ends the making up
  run.options.ask_for_fifo = false;    // it would keep a processor busy
  const std::int64_t start = monotonic_ns();
  run.go(30000);
  const double periods = static_cast<double>(monotonic_ns() - start) * 1e-1;
  EXPECT_GE(run.device.reads, 3) << "a loop that made up for everything would read once or twice";
  EXPECT_LE(run.report.work.quantile_us(0.5), 50000)
      << "2.5 ms of making up, then a reading; somebody else may have the processor meanwhile";
  EXPECT_GT(run.report.skipped_late, 1000);
  EXPECT_GT(run.report.overruns, 1000);
  EXPECT_LE(static_cast<double>(run.report.ticks + run.report.skipped_late), periods + 1);
  EXPECT_EQ(static_cast<std::int64_t>(run.ticks.size()), run.report.ticks);
}

/// SteadyCut cutting at 0.25 mm/s and a press on the simulated Omni, at a tick length, without a
/// clock.
struct SteadyCut {
  double x_mm, cutting_n, press_n, press_x_mm;
};
SteadyCut steady(double tick_s) {
  SteadyCut s{};
  const Tooth tooth = make_cube(6, "dentin", 0.05);
  {
    Rig rig(tooth, {shipped_bur("cylinder-flat-1.0")}, hard_model(0.8, 0.012), {0, 0, 0.1}, tick_s);
    rig.spin_up({0, 0, 0.1});
    (void)rig.travel({0, 0, 0.1}, {0, 0, -2.4}, 0.25, 1.0);
    std::vector<double> x, f;
    const int n = static_cast<int>(2.0 / tick_s);
    for (int i = 1; i <= n; ++i) {
      const TickOutput out = rig.tick({0, 0, -2.4 - 0.25 * tick_s * i}, 1.0);
      x.push_back(out.penetration_mm);
      f.push_back(length(out.rendered_force_n));
    }
    s.x_mm = mean_and_sd(x).mean;
    s.cutting_n = mean_and_sd(f).mean;
  }
  ClosedLoop loop(
      Rig(tooth, {shipped_bur("round-1.0")}, hard_model(0.8, 1.79), {0, 0, 0.2}, tick_s),
      {0, 0, 0.2});
  loop.omni.quantum_mm = 0;  // which quantum it rests in would be chance
  loop.omni.coulomb_n = 0;
  std::vector<double> f, x;
  while (loop.time_s < 16) {
    loop.tick({0, 0, 0.2 - std::min(1.4, 2 * loop.time_s)}, 0);
    if (loop.time_s < 15) continue;
    f.push_back(length(loop.last.rendered_force_n));
    x.push_back(loop.last.penetration_mm);
  }
  s.press_n = mean_and_sd(f).mean;
  s.press_x_mm = mean_and_sd(x).mean;
  return s;
}

TEST(RealTime, At4KilohertzThePhysicsIsThatOf1KilohertzWithin1Percent) {
  const SteadyCut slow = steady(0.001), fast = steady(0.00025);
  std::printf(
      "1 kHz: X %.4f mm, %.4f N cutting, %.4f N and %.4f mm pressing; 4 kHz: %.4f, %.4f, %.4f, %.4f\n",
      slow.x_mm, slow.cutting_n, slow.press_n, slow.press_x_mm, fast.x_mm, fast.cutting_n,
      fast.press_n, fast.press_x_mm);
  EXPECT_NEAR(fast.x_mm / slow.x_mm, 1.0, 0.01);
  EXPECT_NEAR(fast.cutting_n / slow.cutting_n, 1.0, 0.01);
  EXPECT_NEAR(fast.press_n / slow.press_n, 1.0, 0.01);
  EXPECT_NEAR(fast.press_x_mm / slow.press_x_mm, 1.0, 0.01);
}

TEST(RealTime, RunsAt4KilohertzToo) {
  Live run({});
  run.rig = Rig(make_cube(4, "dentin", 0.1), {shipped_bur("round-1.0")}, hard_model(0.8, 0.012),
                {0, 0, 0.1}, 0.00025);
  const std::int64_t start = monotonic_ns();
  run.go(2000);
  const double seconds = static_cast<double>(monotonic_ns() - start) * 1e-9;
  EXPECT_GE(seconds, 0.499) << "never faster than real time";
  EXPECT_LE(seconds, 0.499 + k_patience_s);
  // after a late tick the force comes back within milliseconds, and the last of them may stand
  // there
  std::vector<double> force_n;
  for (auto tick = run.ticks.begin() + static_cast<std::ptrdiff_t>(run.ticks.size() / 2);
       tick != run.ticks.end(); ++tick)
    force_n.push_back(length(tick->output.rendered_force_n));
  EXPECT_NEAR(quantile(force_n, 0.5), 0.64, 0.02);
  EXPECT_LE(*std::max_element(force_n.begin(), force_n.end()), 0.66);
}

/// What `start` does in a process of its own that has room for only so many stacks of 256 MB: 0 it
/// ran, 1 Error with the stream closed, 2 something else; -1 the process died.
int started_with_room_for(int stacks) {
  const pid_t child = ::fork();
  if (child == 0) {
    Live live(nullptr);
    live.options.ask_for_memory = live.options.ask_for_fifo = false;
    live.options.max_ticks = 5;
    RealTimeServo servo(live.rig.model, live.rig.state, live.device, live.stream, {}, live.options);
    constexpr std::size_t k_stack = 256u << 20;
    pthread_attr_t attributes;
    ::pthread_attr_init(&attributes);
    ::pthread_attr_setstacksize(&attributes, k_stack);
    ::pthread_setattr_default_np(&attributes);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t most = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + k_stack / 2 +
                        static_cast<std::size_t>(stacks) * k_stack;
    const struct rlimit limit { most, most };
    ::setrlimit(RLIMIT_AS, &limit);
    try {
      servo.start();
      servo.join();
      ::_exit(0);
    } catch (const Error&) {
      ::_exit(live.stream.closed() && !servo.running() ? 1 : 2);
    } catch (...) {
      ::_exit(2);
    }
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(RealTime, AThreadThatCannotBeHadIsAnErrorAndNotTheEndOfTheProgram) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need the address space";
#endif
  EXPECT_EQ(started_with_room_for(0), 1) << "not even the guard";
  EXPECT_EQ(started_with_room_for(1), 1) << "the guard, but not the servo";
  EXPECT_EQ(started_with_room_for(4), 0);
}

}  // namespace
}  // namespace cavum
