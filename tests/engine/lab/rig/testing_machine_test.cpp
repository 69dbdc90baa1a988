#include "engine/lab/rig/testing_machine.h"

#include <gtest/gtest.h>

#include "engine/base/statistics.h"
#include "engine/lab/rig/rig_error.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

struct Steady {
  double force_n = 0, penetration_mm = 0;
};

/// Mean of the last half second after six time constants of cutting.
Steady steady(double k, double c, double tau_s, double speed_mm_s, MachineSettings settings) {
  settings.speed_mm_s = speed_mm_s;
  const Tooth block = make_block({4, 4, 4}, {{"dentin", 4.0}}, 0.05);
  const ServoModel servo =
      machine_servo(block, shipped_bur("round-1.0"), hard_model(k, c, tau_s), settings.omni);
  TestingMachine machine(servo, block, {0.1, 0.2, 0.3}, settings, Random(1));
  const double branch_s = c / servo.force.rendering.kvc_n_per_mm;
  const int ticks =
      static_cast<int>((0.3 / speed_mm_s + 6 * std::max(tau_s, branch_s)) / k_tick_s) + 500;
  Steady out;
  for (int i = 0; i < ticks; ++i) {
    const MachineReading& r = machine.tick();
    if (i < ticks - 500) continue;
    out.force_n += r.exact_n / 500;
    out.penetration_mm += r.servo.penetration_mm / 500;
  }
  return out;
}

MachineSettings exact_encoder() {
  MachineSettings s;
  s.omni.quantum_mm = 0;
  return s;
}

TEST(TestingMachine, SteadyCutHasXOfVTauAndTheVoigtForcePlusFriction) {
  for (const double speed : {0.25, 0.5})
    for (const double c : {0.0, 0.3}) {
      const double k = 0.8, tau = 0.5;
      MachineSettings s = exact_encoder();
      const Steady got = steady(k, c, tau, speed, s);
      EXPECT_NEAR(got.penetration_mm, speed * tau, 0.02 * speed * tau) << speed << " mm/s, c " << c;
      const double expected =
          k * speed * tau + c * speed + s.omni.coulomb_n + s.omni.viscous_n_s_per_mm * speed;
      EXPECT_NEAR(got.force_n, expected, 0.02 * expected) << speed << " mm/s, c " << c;
    }
}

TEST(TestingMachine, CoarseEncoderChangesTheMeanByLessThanAStepOfForce) {
  MachineSettings coarse;
  const Steady exact = steady(0.8, 0.3, 0.5, 0.25, exact_encoder()),
               seen = steady(0.8, 0.3, 0.5, 0.25, coarse);
  EXPECT_NEAR(seen.force_n, exact.force_n, 0.8 * coarse.omni.quantum_mm);
}

TEST(TestingMachine, WithTheHandpieceStillItIndentsAndTheForceIsThatOfTheSpring) {
  const Tooth block = make_block({4, 4, 2}, {{"dentin", 2.0}}, 0.05);
  const ServoModel servo =
      machine_servo(block, shipped_bur("round-1.0"), hard_model(0.8, 0.0), exact_encoder().omni);
  TestingMachine machine(servo, block, {0, 0, 0.1}, exact_encoder(), Random(1), false);
  double removed = 0;
  for (int i = 0; i < 4000; ++i) removed += machine.tick().servo.removed_count;
  const MachineReading& r = machine.tick();
  EXPECT_EQ(removed, 0);
  EXPECT_NEAR(r.motor_n, -0.8 * r.crosshead_mm, 0.01 * 0.8 * 0.9);
}

TEST(TestingMachine, StiffnessIsReplacedAndTheDampingRatioKept) {
  for (const double k : {0.2, 1.2}) {
    const Viscoelastic paper =
        with_stiffness(shipped_model("paper"), "dentin", k).materials.find("dentin")->second.voigt;
    EXPECT_EQ(paper.stiffness_n_per_mm, k);
    EXPECT_NEAR(paper.damping_n_s_per_mm, paper_damping_n_s_per_mm(k), 1e-12);
    const Viscoelastic own = with_stiffness(shipped_model("consistent"), "dentin", k)
                                 .materials.find("dentin")
                                 ->second.voigt;
    EXPECT_NEAR(own.damping_n_s_per_mm, consistent_damping_n_s_per_mm(k, 0.045), 1e-9);
  }
  EXPECT_EQ(code_of([] { (void)with_stiffness(shipped_model("paper"), "bone", 1.0); }),
            RigError::no_material);
  EXPECT_EQ(code_of([] { (void)with_stiffness(shipped_model("paper"), "pulp", 1.0); }),
            RigError::no_stiffness);
}

}  // namespace
}  // namespace cavum
