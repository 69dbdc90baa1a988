#include "engine/device/simulated_omni.h"

#include <gtest/gtest.h>

#include "engine/base/det_math.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

constexpr double k_dt = 0.001;

OmniModel ideal() {
  OmniModel omni;
  omni.coulomb_n = 0;
  omni.quantum_mm = 0;
  omni.delay_ticks = 0;
  return omni;
}

TEST(SimulatedOmni, DeflectsAgainstTheHandsSpringAsForceOverStiffness) {
  for (const double k : {0.1, 0.3, 1.0, 2.0})
    for (const double force : {0.5, 1.0, 2.0}) {
      HandModel hand;
      hand.stiffness_n_per_mm = k;
      OmniState state = make_omni_state({1, 2, 3});
      Vec3 at;
      for (int i = 0; i < 20000; ++i)
        at = advance_omni(ideal(), hand, state, {0, force, 0}, {1, 2, 3}, k_dt);
      EXPECT_LE(length(at - Vec3{1, 2 + force / k, 3}), 1e-6) << k << " N/mm, " << force << " N";
      OmniModel rough = ideal();
      rough.coulomb_n = 0.26;
      state = make_omni_state({1, 2, 3});
      for (int i = 0; i < 20000; ++i)
        at = advance_omni(rough, hand, state, {0, force, 0}, {1, 2, 3}, k_dt);
      EXPECT_LE(std::fabs(at.y - 2 - force / k), 0.26 / k + 1e-6)
          << "friction may hold it up by no more than its own force";
    }
}

TEST(SimulatedOmni, FrictionHoldsBelow026NAndNotAbove) {
  HandModel free;
  free.stiffness_n_per_mm = free.damping_n_s_per_mm = 0;
  OmniModel omni;
  omni.quantum_mm = 0;
  const auto way = [&](double force) {
    OmniState state = make_omni_state({});
    Vec3 at;
    for (int i = 0; i < 1000; ++i)
      at = advance_omni(omni, free, state, normalized(Vec3{1, -2, 2}) * force, {}, k_dt);
    return length(at);
  };
  EXPECT_EQ(way(0.255), 0.0);
  EXPECT_GT(way(0.28), 0.1);
}

TEST(SimulatedOmni, FreeMotionIsThatOfAMassUnderForceAndFriction) {
  HandModel free;
  free.stiffness_n_per_mm = free.damping_n_s_per_mm = 0;
  OmniModel omni = ideal();
  omni.coulomb_n = 0.26;
  omni.viscous_n_s_per_mm = 0;
  OmniState state = make_omni_state({});
  for (int i = 0; i < 200; ++i) (void)advance_omni(omni, free, state, {1, 0, 0}, {}, k_dt);
  const double a = 1000 * (1 - 0.26) / 0.145;  // mm/s²
  EXPECT_NEAR(state.velocity_mm_s.x, a * 0.2, 1e-6 * a);
  EXPECT_NEAR(state.position_mm.x, a * 0.02, 0.005 * a * 0.02);
  double coasting = state.velocity_mm_s.x;
  int ticks = 0;
  for (; length(state.velocity_mm_s) > 0 && ticks < 10000; ++ticks) {
    (void)advance_omni(omni, free, state, {}, {}, k_dt);
    ASSERT_LE(state.velocity_mm_s.x, coasting);
    ASSERT_GE(state.velocity_mm_s.x, 0.0) << "friction reversed the motion";
    coasting = state.velocity_mm_s.x;
  }
  EXPECT_NEAR(ticks * k_dt, a * 0.2 / (1000 * 0.26 / 0.145), 0.002) << "stops after m v / F";
}

TEST(SimulatedOmni, OscillatesAtTheFrequencyOfMassAndSpringAndLosesEnergy) {
  HandModel hand;
  hand.stiffness_n_per_mm = 0.3;
  hand.damping_n_s_per_mm = 0;
  OmniModel omni = ideal();
  omni.viscous_n_s_per_mm = 0;
  OmniState state = make_omni_state({2, 0, 0});
  double before = 2, first = -1, last = -1;
  int crossings = 0;
  for (int i = 1; i <= 600; ++i) {
    const double x = advance_omni(omni, hand, state, {}, {}, k_dt).x;
    if (before > 0 && x <= 0) {
      last = i * k_dt;
      if (crossings++ == 0) first = last;
    }
    before = x;
    const double energy =
        0.5 * 0.3 * x * x + 0.5 * 0.145e-3 * dot(state.velocity_mm_s, state.velocity_mm_s);
    ASSERT_LE(energy, 0.5 * 0.3 * 4 * 1.01) << "the simulation itself made energy";
  }
  ASSERT_GE(crossings, 3);
  EXPECT_NEAR((last - first) / (crossings - 1) / (2 * k_pi * std::sqrt(0.145 / 300)), 1.0, 0.03);
}

TEST(SimulatedOmni, ReportsWholeQuanta) {
  Random random(drawn_seed("SimulatedOmni.ReportsWholeQuanta"));
  const OmniModel omni;
  OmniState state = make_omni_state({});
  for (int i = 0; i < 3000; ++i) {
    const double t = i * k_dt;
    const Vec3 at = advance_omni(omni, {}, state, random_direction(random),
                                 {5 * std::sin(3 * t), 2 * t, -t}, k_dt);
    for (const auto& [told, is] : {std::pair{at.x, state.position_mm.x},
                                   {at.y, state.position_mm.y},
                                   {at.z, state.position_mm.z}}) {
      ASSERT_NEAR(told / 0.055, std::round(told / 0.055), 1e-9);
      ASSERT_LE(std::fabs(told - is), 0.0275 + 1e-9);
    }
  }
}

TEST(SimulatedOmni, MotorsSaturateAt3_3N) {
  OmniState at_peak = make_omni_state({}), beyond = make_omni_state({});
  const Vec3 along = normalized(Vec3{1, 1, -1});
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a = advance_omni(ideal(), {}, at_peak, along * 3.3, {}, k_dt),
               b = advance_omni(ideal(), {}, beyond, along * 50, {}, k_dt);
    ASSERT_LE(length(a - b), 1e-9);
  }
  EXPECT_NEAR(length(at_peak.position_mm), 3.3 / 2.0, 0.01);
}

TEST(SimulatedOmni, DelayShiftsTheAnswerByItsTicks) {
  Random random(drawn_seed("SimulatedOmni.DelayShiftsTheAnswerByItsTicks"));
  std::vector<Vec3> commands(300);
  for (auto& c : commands) c = random_direction(random) * random.uniform(0, 3);
  const auto track = [&](int delay) {
    OmniModel omni = ideal();
    omni.delay_ticks = delay;
    OmniState state = make_omni_state({});
    std::vector<Vec3> at;
    for (const auto& c : commands) at.push_back(advance_omni(omni, {}, state, c, {}, k_dt));
    return at;
  };
  const auto prompt = track(0);
  EXPECT_GT(length(prompt[0]), 0.0);
  for (const int delay : {1, 2, 3}) {
    const auto late = track(delay);
    for (std::size_t i = 0; i < late.size(); ++i) {
      const auto d = static_cast<std::size_t>(delay);
      ASSERT_EQ(late[i], i < d ? Vec3{} : prompt[i - d]) << delay << " ticks, tick " << i;
    }
  }
}

TEST(SimulatedOmni, AStiffHandDoesNotRing) {
  HandModel hand;
  hand.stiffness_n_per_mm = 50;
  OmniState state = make_omni_state({});
  for (int i = 0; i < 3000; ++i) (void)advance_omni(ideal(), hand, state, {}, {1, 0, 0}, k_dt);
  EXPECT_LE(length(state.position_mm - Vec3{1, 0, 0}), 1e-6);
  EXPECT_LE(length(state.velocity_mm_s), 1e-6);
}

}  // namespace
}  // namespace cavum
