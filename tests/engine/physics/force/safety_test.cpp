#include "engine/physics/force/safety.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/physics/force/notices.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

struct Gate {
  SafetyLimits limits{};
  SafetyState state{};
  std::uint16_t notices = 0;
  double dt_s = 0.001;

  Vec3 give(Vec3 wanted, bool fresh = true) {
    notices = 0;
    return make_safe(limits, state, wanted, fresh, dt_s, notices);
  }
};

TEST(Safety, NoInputDrivesTheForcePastPeakSlewOrANumber) {
  Random random(drawn_seed("Safety.NoInputDrivesTheForcePastPeakSlewOrANumber"));
  const double odd[] = {
      NAN, INFINITY, -INFINITY, 1e308, -1e308, std::numeric_limits<double>::denorm_min(), 0.0};
  for (const double dt : {0.001, 0.00025}) {
    Gate gate;
    gate.dt_s = dt;
    Vec3 before;
    for (int i = 0; i < 50000; ++i) {
      const auto value = [&] {
        return random.below(20) == 0 ? odd[random.below(7)] : random.uniform(-10, 10);
      };
      const Vec3 wanted{value(), value(), value()};
      const Vec3 f = gate.give(wanted, random.below(5) != 0);
      ASSERT_TRUE(is_finite(f));
      ASSERT_LE(length(f), 3.3 + 1e-9);
      ASSERT_LE(length(f - before), gate.limits.slew_n_per_s * dt + 1e-9);
      ASSERT_EQ((gate.notices & k_notice_not_finite) != 0, !is_finite(wanted));
      before = f;
    }
  }
}

TEST(Safety, ModestForcesPassUnchangedWithoutNotice) {
  Random random(drawn_seed("Safety.ModestForcesPassUnchangedWithoutNotice"));
  Gate gate;
  Vec3 wanted;
  for (int i = 0; i < 20000; ++i) {
    wanted = wanted * 0.99 + random_direction(random) * 0.008;
    ASSERT_EQ(gate.give(wanted), wanted);
    ASSERT_EQ(gate.notices, 0);
  }
}

TEST(Safety, ClampKeepsTheDirection) {
  Gate gate;
  const Vec3 wanted{6, -8, 0};
  Vec3 f;
  for (int i = 0; i < 10; ++i) f = gate.give(wanted);
  EXPECT_NEAR(length(f), 3.3, 1e-12);
  EXPECT_LE(length(f - wanted * 0.33), 1e-12);
  EXPECT_EQ(gate.notices, k_notice_force_clamped);
}

TEST(Safety, SlewLimitsAStep) {
  Gate gate;
  const double most = gate.limits.slew_n_per_s * gate.dt_s;
  ASSERT_LT(most, 1.0);
  EXPECT_NEAR(gate.give({3, 0, 0}).x, most, 1e-12);
  EXPECT_EQ(gate.notices, k_notice_slew_limited);
  EXPECT_NEAR(gate.give({3, 0, 0}).x, 2 * most, 1e-12);
}

TEST(Safety, SustainedForceSinksToTheContinuousRatingWithinItsBudget) {
  Gate gate;
  double above_n_s = 0, f = 0, worst_step = 0;
  bool told = false;
  for (int i = 0; i < 120000; ++i) {
    const double next = gate.give({0, 0, 3.3}).z;
    if (i > 20) worst_step = std::max(worst_step, std::fabs(next - f));
    f = next;
    above_n_s += std::max(0.0, f - 0.88) * 0.001;
    told = told || (gate.notices & k_notice_force_budget) != 0;
  }
  EXPECT_TRUE(told);
  EXPECT_NEAR(f, 0.88, 0.01) << "after two minutes";
  EXPECT_LE(above_n_s, 30.01);
  EXPECT_GE(above_n_s, 27.0) << "the budget may be used";
  EXPECT_LE(worst_step, 0.01) << "it sinks, it does not drop";
  for (int i = 0; i < 60000; ++i) (void)gate.give({});
  for (int i = 0; i < 100; ++i) f = gate.give({0, 0, 3.3}).z;
  EXPECT_NEAR(f, 3.3, 1e-12) << "rest gives the budget back";
}

TEST(Safety, TheContinuousRatingMayBeGivenWithoutEnd) {
  Gate gate;
  Vec3 f;
  for (int i = 0; i < 300000; ++i) f = gate.give({0.88, 0, 0});
  EXPECT_DOUBLE_EQ(f.x, 0.88);
}

/// Ticks of silence until the force is zero, from a force that was at rest.
int ticks_to_zero(Gate& gate, Vec3 wanted) {
  for (int i = 0; i < 100; ++i) (void)gate.give(wanted);
  for (int n = 1; n < 1000; ++n)
    if (length(gate.give(wanted, false)) < 1e-9) return n;
  return 1000;
}

TEST(Safety, SilentStylusFadesTheForceToZeroWithin10Ms) {
  for (const double dt : {0.001, 0.00025})
    for (const double n : {0.3, 0.88, 2.0, 3.0, 3.3}) {
      Gate gate;
      gate.dt_s = dt;
      EXPECT_LE(ticks_to_zero(gate, {0, n, 0}) * dt, 0.010 + 1e-9)
          << n << " N at a tick of " << dt << " s";
      EXPECT_NE(gate.notices & k_notice_stale_stylus, 0);
      EXPECT_LE(length(gate.give({0, n, 0}, false)), 1e-9) << "and it stays at zero";
    }
}

TEST(Safety, AShortSilenceChangesNothing) {
  Gate gate;
  const Vec3 wanted{0, 1, 0};
  for (int i = 0; i < 10; ++i) (void)gate.give(wanted);
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 5; ++i) {
      ASSERT_EQ(gate.give(wanted, false), wanted) << "5 ms are allowed";
      ASSERT_EQ(gate.notices, 0);
    }
    ASSERT_EQ(gate.give(wanted), wanted);
  }
}

TEST(Safety, TheForceComesBackAtTheSlewRateAfterSilence) {
  Gate gate;
  (void)ticks_to_zero(gate, {0, 0, 2});
  EXPECT_NEAR(gate.give({0, 0, 2}).z, gate.limits.slew_n_per_s * gate.dt_s, 1e-9);
}

}  // namespace
}  // namespace cavum
