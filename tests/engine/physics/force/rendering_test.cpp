#include "engine/physics/force/rendering.h"

#include <gtest/gtest.h>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

struct Press {
  RenderingModel model;
  Viscoelastic tissue;
  double dt_s = 0.001;
  RenderState state{};
  double x_mm = 0;

  double to(double x) {
    const double approach = x - x_mm;
    x_mm = x;
    update_speed(model, state, true, approach, dt_s);
    return render_force_n(model, tissue, state, true, x, approach, dt_s);
  }
};

std::vector<Viscoelastic> shipped_tissues() {
  std::vector<Viscoelastic> out;
  for (const char* set : {"paper", "consistent"})
    for (const auto& [name, m] : shipped_model(set).materials)
      if (m.voigt.stiffness_n_per_mm > 0) out.push_back(m.voigt);
  for (const double k : {0.2, 0.4, 1.2}) out.push_back({k, 2 * std::sqrt(k)});
  out.push_back({0.8, 0});
  return out;
}

TEST(Rendering, AtRestIsTheSpringWithin1Percent) {
  for (const auto tissue : shipped_tissues())
    for (const double dt : {0.001, 0.00025})
      for (const double x : {0.05, 0.25, 1.0}) {
        Press run{{}, tissue, dt};
        double f = 0;
        for (double t = 0; t < 0.02; t += dt) f = run.to(x * t / 0.02);  // quickly in
        const double settle = 0.03 + 8 * tissue.damping_n_s_per_mm /
                                         run.model.kvc_n_per_mm;  // the branch relaxes with c/Kvc
        for (double t = 0; t < settle; t += dt) f = run.to(x);
        EXPECT_NEAR(f / (tissue.stiffness_n_per_mm * x), 1.0, 0.01)
            << "k " << tissue.stiffness_n_per_mm << " c " << tissue.damping_n_s_per_mm << " X "
            << x;
      }
}

TEST(Rendering, AtConstantSpeedSettlesOnTheVoigtLawWithin2Percent) {
  for (const auto tissue : shipped_tissues())
    for (const double dt : {0.001, 0.00025})
      for (const double v : {0.05, 0.25, 1.0, 5.0}) {
        Press run{{}, tissue, dt};
        double f = 0, t = 0;
        const double settle = 0.05 + 8 * tissue.damping_n_s_per_mm / run.model.kvc_n_per_mm;
        for (int i = 1; t < settle; ++i) f = run.to(v * (t = i * dt));
        const double law = tissue.stiffness_n_per_mm * run.x_mm + tissue.damping_n_s_per_mm * v;
        EXPECT_NEAR(f / law, 1.0, 0.02) << "k " << tissue.stiffness_n_per_mm << " c "
                                        << tissue.damping_n_s_per_mm << " V " << v << " dt " << dt;
      }
}

TEST(Rendering, TheBranchFollowsItsClosedFormOnARamp) {  // z = c V (1 - exp(-t Kvc/c))
  Press run{{}, {0.0, 1.7888543819998317}, 0.001};
  run.model.filtered_damping_n_s_per_mm = 0;
  for (int i = 1; i <= 5000; ++i) {
    const double t = i * 0.001,
                 z = run.tissue.damping_n_s_per_mm * 0.25 *
                     (1 - std::exp(-t * run.model.kvc_n_per_mm / run.tissue.damping_n_s_per_mm));
    ASSERT_NEAR(run.to(0.25 * t), z, 2e-4);
  }
}

TEST(Rendering, WithoutDampingIsTheSpringAlone) {
  Random random(drawn_seed("Rendering.WithoutDampingIsTheSpringAlone"));
  Press run{{}, {0.8, 0.0}};
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(0.001, 1);
    ASSERT_DOUBLE_EQ(run.to(x), 0.8 * x);
  }
  Press nothing{{}, {0.0, 0.0}};
  EXPECT_EQ(nothing.to(0.7), 0.0) << "pulp resists nothing";
}

TEST(Rendering, NeverPulls) {
  Random random(drawn_seed("Rendering.NeverPulls"));
  for (int round = 0; round < 50; ++round) {
    Press run{{}, {random.uniform(0, 1.5), random.uniform(0, 2.5)}};
    int at_zero = 0;
    for (int i = 0; i < 400; ++i) {
      const double f = run.to(random.uniform(0, 0.5));
      ASSERT_GE(f, 0.0);
      at_zero += f == 0.0;
    }
    (void)at_zero;
  }
  Press pulled{{}, {0.2, 1.79}};
  (void)pulled.to(1.0);
  for (int i = 0; i < 4000; ++i) (void)pulled.to(1.0);
  EXPECT_EQ(pulled.to(0.2), 0.0) << "a quick retreat would pull without the clip";
}

TEST(Rendering, LeavingContactForgetsTheBranch) {
  Press run{{}, {0.8, 1.79}};
  (void)run.to(0.5);
  EXPECT_GT(run.state.branch_n, 0.1);
  update_speed(run.model, run.state, false, 0, 0.001);
  EXPECT_EQ(render_force_n(run.model, run.tissue, run.state, false, 0, 0, 0.001), 0.0);
  EXPECT_EQ(run.state.branch_n, 0.0);
  EXPECT_EQ(run.state.speed_mm_s, 0.0);
}

TEST(Rendering, TheBranchGivesBackNoMoreThanItTook) {
  // Energy taken up since rest, sum of F·dX, must never fall below zero: on any way, in any closed
  // cycle, at any tick.
  Random random(drawn_seed("Rendering.TheBranchGivesBackNoMoreThanItTook"));
  for (int round = 0; round < 400; ++round) {
    const double c = std::exp(random.uniform(std::log(1e-4), std::log(10.0))),
                 dt = random.uniform(1e-4, 0.01);
    Press run{{}, {0.0, c}, dt};
    run.model.filtered_damping_n_s_per_mm = 0;
    double absorbed = 0, x = 0, most = 0;
    const double turn = random.uniform(0.01, 1), size = random.uniform(0.01, 1);
    for (int i = 0; i < 600; ++i) {
      const double target = i >= 590
                                ? 0.0
                                : size * (round % 2 ? random.uniform(-1, 1)
                                                    : std::sin(i * turn));  // ends where it began
      const double f = run.to(target);
      absorbed += f * (target - x);
      x = target;
      most = std::max(most, absorbed);
      ASSERT_GE(absorbed, -1e-12) << "round " << round << " c " << c << " dt " << dt;
    }
    ASSERT_GT(most, 0.0);
  }
}

TEST(Rendering, TheBranchHoldsNoMoreThanTheLawAtTheFastestSpeedLeftOpen) {
  Press run{{}, {0.8, 1.79}};
  run.model.filtered_damping_n_s_per_mm = 0;
  (void)run.to(1.0);
  EXPECT_GT(run.state.branch_n, 0.6);
  (void)render_force_n(run.model, run.tissue, run.state, true, 1.0, 0.0, 0.001, 0.0, 0.2);
  EXPECT_NEAR(run.state.branch_n, 1.79 * 0.2, 1e-12);
  run.state.branch_n = -0.6;
  (void)render_force_n(run.model, run.tissue, run.state, true, 1.0, 0.0, 0.001, 0.0, 0.2);
  EXPECT_NEAR(run.state.branch_n, -1.79 * 0.2, 1e-12) << "neither when it pulls";
  EXPECT_EQ(render_force_n(run.model, {0.8, 0.0}, run.state, true, 1.0, 0.0, 0.001), 0.8)
      << "without damping there is nothing to bound";
}

TEST(Rendering, SpeedFilterSettlesOnTheSpeed) {
  RenderState state;
  const RenderingModel model;
  for (int i = 0; i < 5; ++i) update_speed(model, state, true, 0.002, 0.001);
  EXPECT_NEAR(state.speed_mm_s, 2.0 * (1 - std::pow(5.0 / 6.0, 5)),
              1e-12);  // backward Euler of a 5 ms lag
  for (int i = 0; i < 100; ++i) update_speed(model, state, true, 0.002, 0.001);
  EXPECT_NEAR(state.speed_mm_s, 2.0, 1e-6);
}

}  // namespace
}  // namespace cavum
