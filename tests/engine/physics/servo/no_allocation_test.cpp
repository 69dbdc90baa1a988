// Replaces operator new in this test program to see whether the step allocates.
#include <gtest/gtest.h>

#include "engine/physics/servo/real_time.h"
#include "engine/tooth/make/make_block.h"
#include "tests/allocation/counted_new.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(Servo, TheStepAllocatesNothingWhileDrilling) {
  const Tooth tooth = make_block(
      {3, 3, 3}, {{"enamel", 0.8}, {"dentin", 0.7}, {"pulp", 0.5}, {"dentin", 1.0}}, 0.05);
  ForceModel force = hard_model(0.8, 1.79, 0.3);
  force.terms = {make_force_term("coulomb_friction", {{"fc_n", 0.2}, {"v0_mm_s", 0.5}}, "test"),
                 make_force_term("series_compliance", {{"ks_n_per_mm", 5.0}}, "test"),
                 make_force_term("run_out", {{"eccentricity_um", 10.0}}, "test")};
  Rig rig(tooth,
          {shipped_bur("round-1.0"), shipped_bur("cylinder-flat-1.0"), shipped_bur("pear-1.0")},
          force, {0, 0, 0.2});
  long removed = 0, carving_ticks = 0, before = 0;
  t_allocations = 0;
  for (int i = 0; i < 10000; ++i) {
    const double t = i * 1e-3;
    if (i % 3000 == 0) rig.input.bur = static_cast<std::uint8_t>((i / 3000) % 3);
    const Vec3 tip{0.6 * std::sin(2.1 * t), 0.5 * std::sin(1.3 * t),
                   0.2 - 0.25 * t + 0.3 * std::max(0.0, std::sin(t))};
    const Quat turned = normalized(Quat{1, 0.1 * std::sin(0.7 * t), 0.1 * std::cos(0.9 * t), 0});
    rig.input = make_tick_input({tip, turned}, i % 4000 < 3800 ? 1.0 : 0.0,
                                k_stylus_fresh | k_pedal_fresh, rig.input.bur, rig.input);
    t_counting = true;
    const TickOutput out = step(rig.model, rig.state, rig.input);
    (void)state_hash(rig.state);
    t_counting = false;
    ASSERT_EQ(t_allocations, before) << "tick " << i;
    removed += out.removed_count;
    carving_ticks += out.removed_count > 0;
  }
  EXPECT_EQ(t_allocations, 0);
  EXPECT_GT(removed, 10000) << "it must really have drilled";
  EXPECT_GT(carving_ticks, 300);
  t_counting = true;
  ::operator delete(::operator new(8));  // the counter itself counts
  t_counting = false;
  EXPECT_GE(t_allocations, 1);
}

/// Drills, and counts what the servo thread allocates between its first and last reading.
class CountingDevice final : public ServoDevice {
 public:
  [[nodiscard]] DeviceReading read(double) override {
    t_counting = true;
    const double t = static_cast<double>(reads++) * 1e-3;
    allocations = t_allocations;
    return {{{0.3 * std::sin(9 * t), 0, 0.1 - 2 * t}, {}}, 1.0, k_stylus_fresh | k_pedal_fresh, 0};
  }
  void send_force(Vec3) override { allocations = t_allocations; }
  void cut_force() noexcept override {}

  long reads = 0, allocations = -1;
};

TEST(RealTime, TheServoThreadAllocatesNothing) {
  Rig rig(make_cube(4, "dentin", 0.05), {shipped_bur("round-1.0")}, hard_model(0.8, 0.012, 0.3),
          {0, 0, 0.1});
  TickStream stream;
  CountingDevice device;
  RealTimeOptions options;
  options.max_ticks = 800;
  RealTimeServo servo(rig.model, rig.state, device, stream, {}, options);
  servo.start();
  EXPECT_EQ(servo.join().ticks, 800);
  EXPECT_GT(device.reads, 100);
  EXPECT_EQ(device.allocations, 0);
  EXPECT_NE(rig.state.tooth.edit_hash(),
            make_servo_state(rig.model, make_cube(4, "dentin", 0.05), {}).tooth.edit_hash())
      << "it must have drilled";
}

}  // namespace
}  // namespace cavum
