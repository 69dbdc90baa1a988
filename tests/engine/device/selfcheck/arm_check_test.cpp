// The check of a free arm against arms whose friction, mass and weight are known because the test
// made them.
#include "engine/device/selfcheck/arm/arm_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/device/device_error.h"
#include "engine/device/selfcheck/arm/arm_swing.h"
#include "engine/device/selfcheck/check_rule.h"
#include "tests/engine/device/selfcheck/arm_families.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using namespace testing_selfcheck;

constexpr Vec3 k_left_at{3, -2, 1};

/// Friction alone, along the axes: what the drag must find is known.
ArmModel plain_arm() {
  ArmModel m;
  m.mass_kg = {0.08, 0.12, 0.16};
  m.coulomb_n = {0.15, 0.2, 0.25};
  m.stribeck = m.ripple_n = m.viscous_n_s_per_mm = m.skew_rad = 0.0;
  m.weight_n = {0, 0, 0.2};
  return m;
}

TEST(ArmCheck, FindsFrictionMassAndWeightOfEachAxis) {
  FreeArm arm(plain_arm(), k_left_at, 1);
  const ArmFigures f = check_free_arm(arm, 2);
  ASSERT_EQ(f.doubt, Message());
  const ArmModel m = plain_arm();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(f.axes[i].friction_n, m.coulomb_n[i], 0.01) << i;
    EXPECT_NEAR(f.axes[i].mass_kg / m.mass_kg[i], 1.0, 0.05) << i;
  }
  EXPECT_NEAR(f.axes[2].weight_n, 0.2, 0.02);
  EXPECT_NEAR(f.axes[0].weight_n, 0.0, 0.02);
  EXPECT_NEAR(f.quantum_mm, m.quantum_mm, 1e-6);
  EXPECT_NEAR(f.rate_hz, m.rate_hz, 10.0);
  EXPECT_LT(f.seconds, 60.0);
}

TEST(ArmCheck, NeverPushesHarderThanANewton) {
  ArmModel stiff = plain_arm();
  for (double& c : stiff.coulomb_n) c *= 3.0;
  for (const ArmModel& m : {plain_arm(), stiff}) {
    FreeArm arm(m, k_left_at, 3);
    static_cast<void>(check_free_arm(arm, 4));
    EXPECT_LE(arm.largest_force_n(), 1.0 + 1e-9);
    EXPECT_EQ(length(arm.commanded_n()), 0.0) << "it ends without force";
  }
}

TEST(ArmCheck, CableRippleAndWeightDoNotCountAsFriction) {
  ArmModel rough = plain_arm();
  rough.ripple_n = 0.06;
  rough.ripple_mm = 3.1;
  rough.weight_n = {0.1, -0.05, 0.3};
  FreeArm smooth(plain_arm(), k_left_at, 5), rippled(rough, k_left_at, 5);
  EXPECT_NEAR(check_free_arm(smooth, 6).friction_n(), check_free_arm(rippled, 6).friction_n(),
              0.012);
}

TEST(ArmCheck, AWeakerMotorMakesMassAndFrictionSeemLargerByTheSameShare) {
  ArmModel weak = plain_arm();
  weak.gain = 0.9;
  FreeArm before(plain_arm(), k_left_at, 7), now(weak, k_left_at, 7);
  const ArmFigures a = check_free_arm(before, 8), b = check_free_arm(now, 8);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(a.axes[i].mass_kg / b.axes[i].mass_kg, 0.9, 0.03) << i;
    EXPECT_NEAR(a.axes[i].friction_n / b.axes[i].friction_n, 0.9, 0.05) << i;
  }
}

TEST(ArmCheck, SaysThatAHandIsOnIt) {
  for (const ArmHand& hand :
       {ArmHand{0.1, 0.5, 0.005, 0.5}, ArmHand{0.1, 1.0, 0.02, 1.0}, ArmHand{0.2, 2.0, 0.1, 0.4}}) {
    FreeArm arm(plain_arm(), {}, 9);
    arm.set_hand(hand);
    EXPECT_NE(check_free_arm(arm, 10).doubt, Message()) << hand.stiffness_n_per_mm;
    EXPECT_EQ(length(arm.commanded_n()), 0.0);
  }
}

TEST(ArmCheck, SaysThatSomethingStandsInItsWay) {
  FreeArm arm(plain_arm(), {}, 11);
  arm.set_wall(1.5);
  EXPECT_TRUE(testing_basics::tells(check_free_arm(arm, 12).doubt, "x"));
}

TEST(ArmCheck, SaysThatItIsTooFarAway) {
  FreeArm arm(plain_arm(), {80, 0, 0}, 13);
  EXPECT_TRUE(testing_basics::tells(check_free_arm(arm, 14).doubt, 80));
}

TEST(ArmCheck, AStylusThatFallsSilentEndsIt) {
  FreeArm arm(plain_arm(), k_left_at, 15);
  int ticks = 0;
  ArmCheckOptions o;
  o.clock = [now = std::int64_t{1}, &ticks, &arm]() mutable {
    if (++ticks == 5000) arm.fall_silent();
    return now += 1'000'000;
  };
  EXPECT_EQ(testing_basics::code_of([&] { static_cast<void>(check_arm(arm, o)); }),
            DeviceError::silent);
  EXPECT_EQ(length(arm.commanded_n()), 0.0);
}

TEST(ArmCheck, IsStoppedWhenAskedTo) {
  FreeArm arm(plain_arm(), k_left_at, 16);
  ArmCheckOptions o;
  o.clock = [now = std::int64_t{1}]() mutable { return now += 1'000'000; };
  o.stop = [n = 0]() mutable { return ++n > 4000; };
  EXPECT_FALSE(check_arm(arm, o).doubt.empty());
}

/// x'' = (F − friction sign x')/m in closed form: two parabolas a run, the force turning where the
/// test says.
TEST(ArmSwing, FitsParabolasExactly) {
  const double m = 0.1, c = 0.3, force = 0.8, delay = 0.002;
  std::vector<SwingSample> swing;
  double x = 0.0, v = 0.0, way = 1.0;
  const double h = 1e-6;
  std::vector<std::pair<double, double>> commands{{0.0, force}};
  double told = force;
  for (long k = 0; k < 4'000'000; ++k) {
    const double t = static_cast<double>(k) * h;
    double acting = 0.0;
    for (auto it = commands.rbegin(); it != commands.rend(); ++it)
      if (it->first <= t - delay) {
        acting = it->second;
        break;
      }
    if (k % 1000 == 0) {
      if (x * way > 4.0 && v * way > 0) {
        way = -way;
        told = way * force;
        commands.emplace_back(t, told);
        if (commands.size() > 4) commands.erase(commands.begin());
      }
      swing.push_back({t, x, told, true});
    }
    const double push = acting - (v > 0 ? c : v < 0 ? -c : std::copysign(c, acting));
    v += push / m * h * 1000.0;
    x += v * h;
  }
  const std::vector<std::vector<SwingSample>> swings{swing};
  const SwingFit fit = fit_swings(swings).front();
  ASSERT_TRUE(fit.solved);
  EXPECT_NEAR(fit.mass_kg, m, 0.001);
  EXPECT_NEAR(fit.friction_n, c, 0.01);
  EXPECT_NEAR(fit.delay_s, delay, 0.0003);
}

/// The small form of the campaign: fixed seeds, an arm of each family. The figures of
/// docs/selfcheck.md come from `selfcheck_campaign`.
TEST(SelfCheckCampaign, FindsHiddenChangesAndCallsNoOtherCheckChanged) {
  for (const std::string& family : arm_families())
    for (const std::uint64_t seed : {4001U}) {
      const StationTrial t = try_station(family, seed, 8, 1);
      EXPECT_EQ(t.false_alarms, 0) << family << seed;
      EXPECT_TRUE(t.friction_found) << family << seed;
      EXPECT_TRUE(t.gain_found) << family << seed;
      EXPECT_LT(t.longest_s, 60.0);
    }
}

}  // namespace
}  // namespace cavum
