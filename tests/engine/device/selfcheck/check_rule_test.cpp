// The rule on figures that are drawn, without any arm: its false alarms are what they are said to
// be.
#include "engine/device/selfcheck/check_rule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

struct Scatter {
  double friction_n = 0.012, mass = 0.012;
};

ArmFigures drawn(std::mt19937_64& random, const Scatter& s, double friction_n = 0.3,
                 double gain = 1.0, double more_mass_kg = 0.0) {
  std::normal_distribution<double> n;
  ArmFigures f;
  const double day_friction = s.friction_n * n(random), day_mass = s.mass * n(random);
  for (ArmAxis& a : f.axes) {
    a.friction_n = (friction_n + day_friction) / gain;
    a.friction_error_n = 0.001;
    a.mass_kg = (0.1 + more_mass_kg) * std::exp(day_mass) / gain;
    a.mass_error = 0.003;
  }
  f.axes[2].weight_n = (0.05 + 9.81 * more_mass_kg) / gain + 0.002 * n(random);
  f.quantum_mm = 0.02;
  f.rate_hz = 1000.0 + n(random);
  return f;
}

std::vector<ArmFigures> history_of(std::mt19937_64& random, const Scatter& s, std::size_t checks) {
  std::vector<ArmFigures> h;
  while (h.size() < checks) h.push_back(drawn(random, s));
  return h;
}

TEST(CheckRule, ClaimsNothingWhileItLearns) {
  std::mt19937_64 random(1);
  const auto history = history_of(random, {}, k_checks_to_learn - 1);
  EXPECT_EQ(judge_check(drawn(random, {}, 0.9), history).outcome, CheckOutcome::learning);
}

TEST(CheckRule, FalseAlarmsStayBelowWhatIsSaidWhateverTheScatter) {
  std::mt19937_64 random(testing_basics::drawn_seed("CheckRule"));
  EXPECT_LT(k_false_alarms, 0.05);
  for (const Scatter& s : {Scatter{0.003, 0.003}, Scatter{0.02, 0.02}, Scatter{0.1, 0.1}}) {
    int alarms = 0;
    constexpr int k_stations = 3000;
    for (int i = 0; i < k_stations; ++i) {
      const auto history =
          history_of(random, s, k_checks_to_learn + static_cast<std::size_t>(i) % 23);
      alarms += judge_check(drawn(random, s), history).outcome == CheckOutcome::changed ? 1 : 0;
    }
    const double expected = k_stations * k_false_alarms;
    EXPECT_LT(alarms, expected + 4.0 * std::sqrt(expected)) << s.friction_n;
  }
}

TEST(CheckRule, TellsFrictionFromGainFromMass) {
  std::mt19937_64 random(3);
  const Scatter little{0.004, 0.004};
  const auto history = history_of(random, little, 20);
  const CheckVerdict friction = judge_check(drawn(random, little, 0.4), history),
                     gain = judge_check(drawn(random, little, 0.3, 0.9), history),
                     mass = judge_check(drawn(random, little, 0.3, 1.0, 0.02), history);
  ASSERT_EQ(friction.changes.size(), 1U);
  EXPECT_EQ(friction.changes[0].quantity, "friction");
  EXPECT_NEAR(friction.changes[0].change, 0.1, 0.02);
  ASSERT_EQ(gain.changes.size(), 1U) << in_words(gain);
  EXPECT_EQ(gain.changes[0].quantity, "gain");
  EXPECT_NEAR(gain.changes[0].change, -0.1, 0.02);
  ASSERT_GE(mass.changes.size(), 1U);
  EXPECT_EQ(mass.changes[0].quantity, "mass");
  EXPECT_NEAR(mass.changes[0].change, 0.2, 0.03);
}

TEST(CheckRule, AnArmThatHangsByItsOwnWeightTellsNoGainFromMass) {
  std::mt19937_64 random(4);
  const Scatter little{0.004, 0.004};
  const auto hanging = [&](double gain) {
    ArmFigures f = drawn(random, little, 0.3, gain);
    f.axes[2].weight_n = 9.81 * f.axes[2].mass_kg;
    return f;
  };
  std::vector<ArmFigures> history;
  while (history.size() < 20) history.push_back(hanging(1.0));
  const CheckVerdict v = judge_check(hanging(0.9), history);
  ASSERT_GE(v.changes.size(), 1U);
  EXPECT_EQ(v.changes[0].quantity, "gain or mass");
}

TEST(CheckRule, OneAxisAloneIsNamed) {
  std::mt19937_64 random(5);
  const Scatter little{0.004, 0.004};
  const auto history = history_of(random, little, 20);
  ArmFigures f = drawn(random, little);
  f.axes[1].friction_n += 0.1;
  f.axes[2].friction_n -= 0.1;
  const CheckVerdict v = judge_check(f, history);
  ASSERT_EQ(v.changes.size(), 2U) << in_words(v);
  EXPECT_EQ(v.changes[0].axis.empty() || v.changes[1].axis.empty(), false);
}

TEST(CheckRule, StepAndRateAreNamed) {
  std::mt19937_64 random(6);
  const auto history = history_of(random, {}, 20);
  ArmFigures f = drawn(random, {});
  f.quantum_mm = 0.04;
  f.rate_hz = 500.0;
  const CheckVerdict v = judge_check(f, history);
  ASSERT_EQ(v.changes.size(), 2U);
  for (const CheckChange& c : v.changes)
    EXPECT_NEAR(c.change, c.quantity == "step" ? 1.0 : -0.5, 0.01) << c.quantity;
}

TEST(CheckRule, CreepingChangeIsNotLearnt) {
  std::mt19937_64 random(7);
  const Scatter little{0.004, 0.004};
  std::vector<ArmFigures> history = history_of(random, little, k_checks_compared);
  bool found = false;
  for (int day = 1; day < 100 && !found; ++day) {
    const ArmFigures f = drawn(random, little, 0.3 + 0.001 * day);
    found = judge_check(f, history).outcome == CheckOutcome::changed;
    if (!found) history.push_back(f);
  }
  EXPECT_TRUE(found) << "0.1 N in a hundred checks";
}

TEST(CheckRule, DoubtIsNoVerdict) {
  std::mt19937_64 random(8);
  const auto history = history_of(random, {}, 20);
  ArmFigures f = drawn(random, {}, 0.9);
  f.doubt = msg("a hand is on it");
  const CheckVerdict v = judge_check(f, history);
  EXPECT_EQ(v.outcome, CheckOutcome::doubtful);
  EXPECT_TRUE(v.changes.empty());
}

}  // namespace
}  // namespace cavum
