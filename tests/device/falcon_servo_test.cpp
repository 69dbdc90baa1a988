// The Falcon under a servo that works in real time: it presses on a block, is unplugged in the
// middle, and comes back. The session knows, and replays.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "engine/base/file.h"
#include "engine/device/hardware/falcon_stylus.h"
#include "engine/device/hardware/open_stylus.h"
#include "engine/lab/rig/servo_rig.h"
#include "engine/session/session_reader.h"
#include "engine/session/session_writer.h"
#include "engine/session/simulation.h"
#include "engine/session/verify.h"
#include "tests/device/emulated_falcon.h"
#include "tests/device/emulated_pedal.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace std::chrono_literals;

TEST(FalconServo, UnpluggedWhilePressingTheForceFadesAndTheSessionGoesOn) {
  if (!testing_device::EmulatedPedal::possible())
    GTEST_SKIP() << "runs under umockdev-wrapper only: ctest does so";
  const testing_basics::Folder folder;
  ::setenv("CAVUM_HOME", folder.file("").c_str(), 1);
  const std::string data = std::string(CAVUM_SOURCE_DIR) + "/data/", path = folder.file("s.cavum");
  const SessionSetup setup =
      servo_rig_setup(read_text_file(data + "burs/round-1.0.toml"),
                      read_text_file(data + "materials/consistent.toml"), 1e-3);

  testing_device::EmulatedFalcon falcon;
  StationStylus station = usual_station_stylus(falcon_kind());
  Simulation simulation = make_simulation(setup, path);
  const double top_mm = setup.first_tip_mm().z;
  FalconStylus stylus(station);
  const auto hand = [&](double z_mm) {  // tooth frame; the usual placement has z up and the middle
                                        // 120 mm in front
    falcon.move_to(k_falcon_middle_mm + Vec3{0, z_mm, 0});
  };
  hand(top_mm);
  const Pose first = first_pose(stylus, 20.0);
  EXPECT_NEAR(first.tip_mm.z, top_mm, 2 * k_falcon_quantum_mm);

  Recorder recorder = Recorder::create(path, setup);
  TickStream stream;
  RealTimeServo servo(simulation.model, simulation.state, stylus, stream,
                      make_tick_input(first, 0, k_stylus_fresh, 0, {}));
  std::atomic<double> force_n{0.0};
  std::atomic<std::int64_t> tick{0};
  SessionWriter writer(stream, recorder, 1e-3,
                       [&](const ServoTick& t, std::span<const RemovedLeaf>) {
                         tick = t.tick;
                         force_n = length(t.output.rendered_force_n);
                         return true;
                       });
  servo.start();
  writer.start();
  const auto comes_true = [](const auto& condition) {
    for (int i = 0; i < 20000 && !condition(); ++i) std::this_thread::sleep_for(1ms);
    return condition();
  };
  const auto pushes = [&] {
    for (const std::int16_t m : falcon.motors())
      if (m != 0) return true;
    return false;
  };
  // down until it is felt
  double z = top_mm;
  EXPECT_TRUE(comes_true([&] {
    if (force_n < 0.5) hand(z -= 0.01);
    return force_n >= 0.5 && pushes();
  })) << "at "
      << z;
  const std::int64_t at_work = tick;
  falcon.unplug();
  EXPECT_TRUE(comes_true([&] { return force_n == 0.0; }));
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(force_n, 0.0);
  EXPECT_TRUE(servo.running()) << "the exam waits for it";
  const std::int64_t silent = tick;
  falcon.plug_in();
  EXPECT_TRUE(comes_true([&] { return force_n > 0.2 && pushes(); }))
      << testing_basics::text_of(stylus.health().problem);
  servo.ask_to_stop();
  servo.join();
  EXPECT_TRUE(comes_true([&] { return !pushes(); })) << "no force after the end";
  writer.finish();
  recorder.close(save_tooth(drilled_tooth(simulation)), "{}");
  EXPECT_TRUE(verify_session(path).verified);
  int gone = 0, back = 0;
  for (const auto& e : SessionReader(path).events()) {
    gone += e.as<StylusSilent>() != nullptr && e.tick > at_work && e.tick <= silent ? 1 : 0;
    back += e.as<StylusBack>() != nullptr && e.tick > at_work ? 1 : 0;
  }
  EXPECT_GE(gone, 1);
  EXPECT_GE(back, 1);
}

}  // namespace
}  // namespace cavum
