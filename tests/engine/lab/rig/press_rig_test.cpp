#include "engine/lab/rig/press_rig.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

class PressRig : public ::testing::Test {
 protected:
  PressBench bench_ = make_press_bench(shipped_bur("round-1.0"));
  PressOptions options_;
};

TEST_F(PressRig, ExplicitVoigtRingsWithThePapersDampingAndOursDoesNot) {
  for (const int delay : {0, 1}) {
    const PressCell cell{0.8, DampingRule::paper, delay, 0.3, 1.0};
    const PressOutcome ours = press(bench_, cell, options_, Rendering::ours),
                       other = press(bench_, cell, options_, Rendering::explicit_voigt);
    EXPECT_LE(ours.sd_n, 0.02) << delay;
    EXPECT_LE(ours.generated_mj, 0.001);
    EXPECT_LE(ours.late_mj, 0.001);
    EXPECT_LT(ours.peak_n, 1.5);
    EXPECT_GT(other.sd_n, 0.3) << delay;
    EXPECT_GT(other.generated_mj, 1.0) << "a ringing wall gives out energy";
    EXPECT_GT(other.late_mj, 0.1);
    EXPECT_FALSE(other.steady || other.passive);
    EXPECT_NEAR(other.peak_n, 3.3, 1e-6) << "it hits the device's peak";
  }
}

TEST_F(PressRig, AtRestTheForceIsTheLoadWithinTheFriction) {
  options_.omni.quantum_mm = 0;
  for (const double k : {0.4, 1.2})
    for (const double load : {0.5, 2.0}) {
      const PressOutcome o =
          press(bench_, {k, DampingRule::none, 0, 0.3, load}, options_, Rendering::ours);
      // the hand's spring shares the friction's slack with the tissue's
      EXPECT_NEAR(o.mean_n, load, 0.26 * k / (k + 0.3) + 0.02) << k << " " << load;
      EXPECT_TRUE(o.steady && o.passive);
    }
  options_.omni.coulomb_n = 0;
  EXPECT_NEAR(
      press(bench_, {0.8, DampingRule::consistent, 1, 0.3, 1.0}, options_, Rendering::ours).mean_n,
      1.0, 0.01);
}

TEST_F(PressRig, UndampedBothRenderingsAreTheSameSpring) {
  options_.omni.quantum_mm = 0;  // ours estimates the place between its steps
  const PressCell cell{0.8, DampingRule::none, 1, 0.3, 1.0};
  EXPECT_NEAR(press(bench_, cell, options_, Rendering::ours).mean_n,
              press(bench_, cell, options_, Rendering::explicit_voigt).mean_n, 1e-9);
}

TEST_F(PressRig, ContactIsMadeWithoutBouncingAndTheExplicitLawBounces) {
  const PressCell cell{0.8, DampingRule::paper, 1, 0.3, 1.0};
  int explicit_bounces = 0;
  for (const double speed : {5.0, 20.0, 50.0}) {
    EXPECT_EQ(come_down(bench_, cell, speed, options_, Rendering::ours).bounces, 0) << speed;
    explicit_bounces += come_down(bench_, cell, speed, options_, Rendering::explicit_voigt).bounces;
  }
  EXPECT_GT(explicit_bounces, 0);
}

TEST_F(PressRig, EveryPressOfTheTableIsSteadyAndPassiveAndNoContactBounces) {
  const PressResult r = run_press_rig(options_, bench_.bur);
  ASSERT_EQ(r.presses.size(), 216u);
  ASSERT_EQ(r.contacts.size(), 216u);
  double worst = 0;
  int explicit_misses = 0;
  for (const auto& row : r.presses) {
    worst = std::max(worst, row.ours.sd_n);
    explicit_misses += !row.explicit_voigt.steady || !row.explicit_voigt.passive;
  }
  EXPECT_LE(worst, 0.01) << "half of the limit";
  EXPECT_TRUE(r.within_limits());
  EXPECT_GE(explicit_misses, 72) << "every one with the paper's c";
}

TEST_F(PressRig, NoPressHoldsByLuckOfWhereTheEncoderStandsWhenTheLoadIsVaried) {
  int misses = 0, of = 0;
  for (const double k : {0.2, 0.5, 1.2})
    for (const double hand : {0.1, 0.4, 1.0})
      for (double load = 0.31; load < 2.5; load += 0.23) {
        const PressOutcome o =
            press(bench_, {k, DampingRule::paper, of % 3, hand, load}, options_, Rendering::ours);
        ++of;
        misses += !o.steady || !o.passive;
      }
  EXPECT_EQ(misses, 0) << "of " << of;
}

TEST_F(PressRig, TableHasEveryCombinationInOrderAndIsTheSameTwice) {
  options_.k_n_per_mm = {0.4, 0.8};
  options_.damping = {DampingRule::consistent};
  options_.delay_ticks = {0};
  options_.hand_n_per_mm = {0.3};
  options_.press_n = {0.5, 1.0};
  options_.contact_mm_s = {20.0};
  options_.hold_s = 1.0;
  const PressResult r = run_press_rig(options_, bench_.bur);
  ASSERT_EQ(r.presses.size(), 4u);
  ASSERT_EQ(r.contacts.size(), 2u);
  EXPECT_EQ(r.presses[1].cell.press_n, 1.0);
  EXPECT_EQ(r.presses[2].cell.k_n_per_mm, 0.8);
  EXPECT_TRUE(r.within_limits());
  EXPECT_EQ(to_json(r).dump(), to_json(run_press_rig(options_, bench_.bur)).dump());
  options_.limit_sd_n = -1;
  EXPECT_FALSE(run_press_rig(options_, bench_.bur).within_limits())
      << "a limit that nothing can keep";
}

}  // namespace
}  // namespace cavum
