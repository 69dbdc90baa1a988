// The pedal under a servo that cuts in real time: what is unplugged stops the handpiece, is
// recorded, and comes back.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "engine/base/file.h"
#include "engine/device/hardware/hid_pedal.h"
#include "engine/device/simulated_stylus.h"
#include "engine/device/with_pedal.h"
#include "engine/lab/rig/servo_rig.h"
#include "engine/session/session_reader.h"
#include "engine/session/session_writer.h"
#include "engine/session/simulation.h"
#include "engine/session/verify.h"
#include "engine/tooth/make/formula_tooth.h"
#include "tests/device/the_pedal.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;
using EmulatedPedal = testing_device::ThePedal;

TEST(PedalServo, UnpluggedWhileCuttingTheHandpieceStopsAndTheSessionKnows) {
  if (!EmulatedPedal::possible()) GTEST_SKIP() << "runs under umockdev-wrapper only: ctest does so";
  const testing_basics::Folder folder;
  ::setenv("CAVUM_HOME", folder.file("").c_str(), 1);
  const std::string data = std::string(CAVUM_SOURCE_DIR) + "/data/", path = folder.file("s.cavum");
  const SessionSetup setup =
      servo_rig_setup(read_text_file(data + "burs/round-1.0.toml"),
                      read_text_file(data + "materials/consistent.toml"), 1e-3);

  EmulatedPedal plug;
  HidPedal pedal(0x068e, 0x00f2,
                 {.axis = 0, .released = 0, .pressed = 255, .speaks_on_change = false});
  std::atomic<bool> pressed{true}, stop{false};
  Simulation simulation = make_simulation(setup, path);
  Recorder recorder = Recorder::create(path, setup);
  TickStream stream;
  SimulatedStylus stylus({}, {}, 1e-3, drilling_hand);
  WithPedal device(stylus, pedal);
  const TickInput first = make_tick_input({setup.first_tip_mm(), {}}, 0, k_stylus_fresh, 0, {});
  RealTimeServo servo(simulation.model, simulation.state, device, stream, first);
  std::atomic<std::int64_t> tick{0}, last_turning{0};
  std::atomic<double> rpm{0.0};
  SessionWriter writer(stream, recorder, 1e-3,
                       [&](const ServoTick& t, std::span<const RemovedLeaf>) {
                         tick = t.tick;
                         rpm = t.output.rpm;
                         if (t.output.rpm > 0) last_turning = t.tick;
                         return true;
                       });
  std::thread foot([&] {
    while (!stop) {
      if (pressed) plug.report_axes(255, 0, 0);
      std::this_thread::sleep_for(2ms);
    }
  });
  servo.start();
  writer.start();
  const auto comes_true = [](const auto& condition) {
    for (int i = 0; i < 8000 && !condition(); ++i) std::this_thread::sleep_for(1ms);
    return condition();
  };
  EXPECT_TRUE(comes_true([&] { return tick > 1500 && rpm > 1000; }));
  pressed = false;
  std::this_thread::sleep_for(5ms);
  const auto gone = std::chrono::steady_clock::now();
  plug.unplug();
  auto still_turning = gone;  // last moment at which the servo's own device still believed the foot
  while (pedal.read().fresh) still_turning = std::chrono::steady_clock::now();
  EXPECT_TRUE(comes_true([&] { return rpm == 0.0; }));
  EXPECT_LT(still_turning - gone, 50ms);
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(rpm, 0.0);
  const std::int64_t stopped = last_turning;
  plug.plug_in();
  pressed = true;
  EXPECT_TRUE(comes_true([&] { return rpm > 1000; }));
  stop = true;
  foot.join();
  servo.ask_to_stop();
  servo.join();
  writer.finish();
  recorder.close(save_tooth(drilled_tooth(simulation)), "{}");
  EXPECT_TRUE(verify_session(path).verified);
  int lost = 0, back = 0;
  for (const auto& e : SessionReader(path).events()) {
    lost += e.as<PedalLost>() != nullptr && e.tick > stopped - 60 && e.tick <= stopped + 60 ? 1 : 0;
    back += e.as<PedalBack>() != nullptr && e.tick > stopped ? 1 : 0;
  }
  EXPECT_EQ(lost, 1);
  EXPECT_EQ(back, 1);
}

}  // namespace
}  // namespace cavum
