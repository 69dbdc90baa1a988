#include <gtest/gtest.h>

#include "engine/physics/force/term_laws.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/closed_loop.h"

namespace cavum {
namespace {

using namespace testing_engine;

constexpr double k_fc_n = 0.26, k_v0_mm_s = 0.5;

ForceModel friction_model(double k_n_per_mm = 0.8, double c_n_s_per_mm = 0.012) {
  return with_terms(hard_model(k_n_per_mm, c_n_s_per_mm),
                    {{"coulomb_friction", {{"fc_n", k_fc_n}, {"v0_mm_s", k_v0_mm_s}}}});
}

Rig rig_with(const ForceModel& force, Vec3 tip_mm = {0, 0, 1}) {
  return {make_cube(4, "dentin", 0.1), {shipped_bur("round-1.0")}, force, tip_mm};
}

TEST(CoulombFriction, IsFcTanhOfSpeedAndFlipsInAirToo) {
  Random random(drawn_seed("CoulombFriction.IsFcTanhOfSpeedAndFlipsInAirToo"));
  const ForceTermPtr term =
      make_force_term("coulomb_friction", {{"fc_n", k_fc_n}, {"v0_mm_s", k_v0_mm_s}}, "test");
  TermMemory memory{};
  for (int i = 0; i < 5000; ++i) {
    TermInput in;
    in.speed_mm_s = random.uniform(-3, 3);
    in.touching = random.below(2) == 0;
    in.rpm = random.uniform(0, 2e5);
    const TermForce f = term->evaluate(in, memory);
    ASSERT_NEAR(f.drag_n, k_fc_n * std::tanh(in.speed_mm_s / k_v0_mm_s), 1e-12);
    ASSERT_EQ(f.tissue_n, 0.0);
    in.speed_mm_s = -in.speed_mm_s;
    ASSERT_EQ(term->evaluate(in, memory).drag_n, -f.drag_n);
  }
  EXPECT_EQ(memory, TermMemory{});
}

TEST(CoulombFriction, AlongAFeedItAddsToTheVoigtLawAndMayPull) {
  const ForceTerms terms = friction_model().terms;
  TermMemory memory{};
  TermInput in{true, 0.3, 0.25, 0, 0.8, 1.79, 0, 0, 0, 0.001};
  EXPECT_NEAR(force_along_feed_n(terms, in, {&memory, 1}),
              0.8 * 0.3 + 1.79 * 0.25 + k_fc_n * std::tanh(0.5), 1e-12);
  in.approach_mm_s = -2.0;  // the damper's pull is clipped, friction's is not
  EXPECT_NEAR(force_along_feed_n(terms, in, {&memory, 1}), -k_fc_n * std::tanh(4.0), 1e-12);
  in.touching = false;
  in.approach_mm_s = 0.25;
  EXPECT_NEAR(force_along_feed_n(terms, in, {&memory, 1}), k_fc_n * std::tanh(0.5), 1e-12)
      << "air stroke";
  EXPECT_EQ(force_along_feed_n({}, in, {}), 0.0) << "without terms, air resists nothing";
}

TEST(CoulombFriction, InAirTheServoRendersItAgainstTheMotionInEveryDirection) {
  Random random(
      drawn_seed("CoulombFriction.InAirTheServoRendersItAgainstTheMotionInEveryDirection"));
  for (const double speed : {0.1, 0.5, 2.0, 20.0})
    for (int i = 0; i < 5; ++i) {
      const Vec3 from{0, 0, 60}, way = random_direction(random);
      Rig rig = rig_with(friction_model(), from);
      const double law = k_fc_n * std::tanh(speed / k_v0_mm_s), distance = 1.5 + 2 * speed * 0.1;
      TickOutput out = rig.travel(from, from + way * distance, speed);
      EXPECT_LE(length(out.rendered_force_n + way * law), 0.01 * law) << speed << " mm/s";
      EXPECT_LE(length(out.drag_n + way * law), 0.01 * law);
      EXPECT_EQ(out.model_force_n, 0.0) << "there is no contact normal";
      out = rig.travel(from + way * distance, from, speed);
      EXPECT_LE(length(out.rendered_force_n - way * law), 0.01 * law) << "it flips at the reversal";
      EXPECT_LE(length(out.drag_n - way * law), 0.01 * law);
    }
}

TEST(CoulombFriction, InContactTheModelForceHoldsItsPartAlongTheNormal) {
  const double speed = 1.0, law = k_fc_n * std::tanh(speed / k_v0_mm_s);
  Rig rig = rig_with(friction_model(), {0, 0, 0.1});
  TickOutput out = rig.travel({0, 0, 0.1}, {0, 0, -1.2}, speed);
  const double spring = 0.8 * out.penetration_mm + 0.012 * speed;
  EXPECT_NEAR(out.model_force_n, spring + law, 1e-3);
  EXPECT_NEAR(out.rendered_force_n.z, spring + law, 0.01 * (spring + law));
  out = rig.travel({0, 0, -1.2}, {0, 0, -0.2}, speed);
  EXPECT_NEAR(out.model_force_n, 0.8 * out.penetration_mm - 0.012 * speed - law, 1e-3)
      << "on the way out it holds back";
  EXPECT_LT(out.model_force_n, 0.0) << "friction may pull, tissue may not";
}

TEST(CoulombFriction, RenderedFrictionGivesBackNoMoreThanItTook) {
  Random random(drawn_seed("CoulombFriction.RenderedFrictionGivesBackNoMoreThanItTook"));
  for (int round = 0; round < 20; ++round) {
    const ForceTerms terms{make_force_term(
        "coulomb_friction",
        {{"fc_n", random.uniform(0.01, 2)}, {"v0_mm_s", random.uniform(0.01, 5)}}, "test")};
    const RenderingModel rendering;
    TermsState state;
    state.count = 1;
    TermInput in;
    in.dt_s = random.below(2) ? 0.001 : 0.00025;
    double taken_n_mm = 0;
    const double size = random.uniform(0.001, 0.5);
    for (int i = 0; i < 3000; ++i) {
      const Vec3 moved = random_direction(random) * random.uniform(0, size);
      const double before = dot(state.stretch_n, state.stretch_n) / (2 * rendering.drag_n_per_mm);
      const TermsForce f = apply_terms(terms, rendering, in, moved, state);
      const double after = dot(state.stretch_n, state.stretch_n) / (2 * rendering.drag_n_per_mm);
      const double work = -dot(f.rendered_drag_n, moved);
      taken_n_mm += work;
      ASSERT_GE(work - (after - before), -1e-12)
          << "work in, less what the spring stores, is lost as heat";
    }
    ASSERT_GE(taken_n_mm, 0.0);
  }
}

TEST(CoulombFriction, HoldsStillUnderASteadyPushAndStaysCalmInAClosedLoop) {
  for (const int delay : {0, 1})
    for (const double tick_s : {0.001, 0.00025}) {
      ClosedLoop loop(Rig(make_cube(4, "dentin", 0.1), {shipped_bur("round-1.0")}, friction_model(),
                          {0, 0, 0.3}, tick_s),
                      {0, 0, 0.3});
      loop.omni.delay_ticks = delay;
      loop.omni.coulomb_n = 0.0;  // the hardest case: a device without friction of its own
      loop.hand.stiffness_n_per_mm = 1.0;
      std::vector<double> forces;
      const double press_s = 0.5,
                   hold_s = 4.0;  // it creeps: the law is a damper of Fc/v0 near rest
      while (loop.time_s < press_s + hold_s) {
        const double t = std::min(1.0, loop.time_s / press_s);
        loop.tick({0, 0, 0.3 - 2.0 * t}, 0);
        if (loop.time_s > press_s + hold_s - 1.0)
          forces.push_back(length(loop.last.rendered_force_n));
      }
      const MeanAndSd f = mean_and_sd(forces);
      std::printf("press with friction, delay %d, tick %.2f ms: %.3f N, sd %.4f N\n", delay,
                  tick_s * 1e3, f.mean, f.sd);
      EXPECT_GT(f.mean, 0.4);
      EXPECT_LT(f.sd, 0.02);
    }
}

}  // namespace
}  // namespace cavum
