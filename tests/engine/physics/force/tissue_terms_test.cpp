#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/det_math.h"
#include "engine/physics/force/term_laws.h"

namespace cavum {
namespace {

TermInput pressed_at(double x_mm, double v_mm_s) {
  TermInput in;
  in.touching = true;
  in.penetration_mm = x_mm;
  in.approach_mm_s = in.speed_mm_s = v_mm_s;
  in.stiffness_n_per_mm = 0.8;
  in.damping_n_s_per_mm = 0.6;
  in.dt_s = 1e-3;
  return in;
}

TEST(DetMath, LogAndPowersAreThoseOfTheLibrary) {
  for (double x = 1e-6; x < 1e6; x *= 1.37) {
    EXPECT_NEAR(det_log(x), std::log(x), 1e-14 * std::max(1.0, std::fabs(std::log(x))));
    EXPECT_NEAR(det_pow(x, 0.7) / std::pow(x, 0.7), 1.0, 1e-13);
  }
  EXPECT_EQ(det_pow(0.0, 0.5), 0.0);
}

TEST(TissueTerms, FollowTheirFormulae) {
  TermMemory none{};
  EXPECT_NEAR(make_force_term("hidden_layer", {{"dk_n_per_mm", 0.5}, {"d0_mm", 0.2}}, "test")
                  ->evaluate(pressed_at(0.5, 0), none)
                  .tissue_n,
              0.15, 1e-12);
  EXPECT_EQ(make_force_term("hidden_layer", {{"dk_n_per_mm", 0.5}, {"d0_mm", 0.2}}, "test")
                ->evaluate(pressed_at(0.1, 0), none)
                .tissue_n,
            0.0);
  EXPECT_NEAR(make_force_term("graded_stiffness", {{"alpha_per_mm", 0.4}}, "test")
                  ->evaluate(pressed_at(0.5, 0), none)
                  .tissue_n,
              -0.8 * 0.4 * 0.25, 1e-12);
  EXPECT_NEAR(make_force_term("nonlinear_stiffness", {{"m", 1.5}}, "test")
                  ->evaluate(pressed_at(0.5, 0), none)
                  .tissue_n,
              0.8 * (std::pow(0.5, 1.5) - 0.5), 1e-12);
  EXPECT_NEAR(make_force_term("feed_power_law", {{"n", 0.8}}, "test")
                  ->evaluate(pressed_at(0.5, -0.25), none)
                  .tissue_n,
              0.6 * (-std::pow(0.25, 0.8) + 0.25), 1e-12);
  TermInput spinning = pressed_at(0.1, 0);
  EXPECT_EQ(
      make_force_term("edge_force", {{"edge_n", 0.3}}, "test")->evaluate(spinning, none).tissue_n,
      0.0);
  spinning.rpm = 1000;
  EXPECT_EQ(
      make_force_term("edge_force", {{"edge_n", 0.3}}, "test")->evaluate(spinning, none).tissue_n,
      0.3);
}

TEST(TissueTerms, RelaxationDecaysInAHoldAndForgetsInAir) {
  const ForceTermPtr term =
      make_force_term("relaxation", {{"k1_n_per_mm", 0.5}, {"tau1_s", 2.0}}, "test");
  TermMemory memory{};
  double force = 0.0;
  for (int i = 1; i <= 1000; ++i)
    force = term->evaluate(pressed_at(0.5e-3 * i, 0.5), memory).tissue_n;  // 0.5 mm/s for 1 s
  const double peak = 0.5 * 0.5 * 2.0 * (1 - std::exp(-0.5));
  EXPECT_NEAR(force, peak, 1e-9);
  for (int i = 0; i < 3000; ++i) force = term->evaluate(pressed_at(0.5, 0), memory).tissue_n;
  EXPECT_NEAR(force, peak * std::exp(-1.5), 1e-9);
  TermInput air;
  EXPECT_EQ(term->evaluate(air, memory).tissue_n, 0.0);
  EXPECT_EQ(memory[0], 0.0);
}

TEST(FrictionTerms, FollowTheirFormulaeInAirToo) {
  TermInput air;
  air.speed_mm_s = 0.25;
  TermMemory none{};
  EXPECT_NEAR(make_force_term("viscous_friction", {{"b_n_s_per_mm", 0.1}}, "test")
                  ->evaluate(air, none)
                  .drag_n,
              0.025, 1e-12);
  EXPECT_NEAR(
      make_force_term("stribeck_friction",
                      {{"fc_n", 0.1}, {"fs_n", 0.3}, {"vs_mm_s", 0.25}, {"v0_mm_s", 0.01}}, "test")
          ->evaluate(air, none)
          .drag_n,
      0.1 + 0.2 * std::exp(-1.0), 1e-9);
}

}  // namespace
}  // namespace cavum
