#include <gtest/gtest.h>

#include <cmath>

#include "engine/physics/force/term_laws.h"

namespace cavum {
namespace {

TermInput pressed(double x_mm, double dt_s = 1e-3) {
  TermInput in;
  in.touching = true;
  in.penetration_mm = x_mm;
  in.stiffness_n_per_mm = 0.8;
  in.dt_s = dt_s;
  return in;
}

/// Force after going straight to each turning point in turn, with `steps` samples for each leg.
double after(const ForceTerm& term, const std::vector<double>& turns, int steps) {
  TermMemory memory{};
  double from = 0.0, force = 0.0;
  for (const double to : turns) {
    for (int i = 1; i <= steps; ++i)
      force = term.evaluate(pressed(from + (to - from) * i / steps), memory).tissue_n;
    from = to;
  }
  return force;
}

TEST(
    Hysteresis,
    DahlsLoopIsItsClosedForm) {  // z = d (1 − e^(−X/d)); back from X0: z = −d + (z0 + d) e^(−way/d)
  const ForceTermPtr term =
      make_force_term("hysteresis", {{"alpha_n_per_mm", 0.5}, {"d_mm", 0.1}}, "test");
  const double peak = 0.1 * (1 - std::exp(-3.0));
  EXPECT_NEAR(after(*term, {0.3}, 50), 0.5 * peak, 1e-14);
  EXPECT_NEAR(after(*term, {0.3, 0.1}, 50), 0.5 * (-0.1 + (peak + 0.1) * std::exp(-2.0)), 1e-14);
}

TEST(Hysteresis, WithGammaOneHalfItUnloadsStraight) {
  const ForceTermPtr term = make_force_term(
      "hysteresis", {{"alpha_n_per_mm", 0.5}, {"d_mm", 0.1}, {"gamma", 0.5}}, "test");
  const double peak = 0.1 * (1 - std::exp(-3.0));
  EXPECT_NEAR(after(*term, {0.3, 0.26}, 50), 0.5 * (peak - 0.04), 1e-14);
  const double beyond = 0.2 - peak;  // from z = 0 it loads the other way: −d (1 − e^(−way/d))
  const double z = -0.1 * (1 - std::exp(-beyond / 0.1));
  EXPECT_NEAR(after(*term, {0.3, 0.1}, 50), 0.5 * z, 1e-13);
  EXPECT_NEAR(after(*term, {0.3, 0.1, 0.1 - 0.5 * z}, 50), 0.5 * (0.5 * z),
              1e-13);  // and straight up again
}

TEST(Hysteresis, DependsNeitherOnTheStepsNorOnTheSpeed) {
  for (const double gamma : {0.0, 0.2, 0.5}) {
    const ForceTermPtr term = make_force_term(
        "hysteresis", {{"alpha_n_per_mm", 0.5}, {"d_mm", 0.07}, {"gamma", gamma}}, "test");
    const std::vector<double> way{0.3, 0.12, 0.2, 0.05, 0.4};
    EXPECT_NEAR(after(*term, way, 1), after(*term, way, 1000), 1e-13) << gamma;
  }
}

TEST(Hysteresis, SolvesItsDifferentialEquation) {  // against small explicit steps
  for (const double gamma : {0.0, 0.25, 0.5}) {
    double z = 0.0, x = 0.0;
    const double d = 0.08;
    for (int i = 0; i < 400000; ++i) {
      const double v = std::cos(i * 2e-5) + 0.3 * std::cos(i * 7e-5), dx = v * 1e-6;
      z += dx - ((1 - gamma) * std::fabs(dx) * z + gamma * dx * std::fabs(z)) / d;
      x += dx;
    }
    double exact = 0.0;
    for (int i = 0; i < 400000; i += 1000) {
      double dx = 0.0;
      for (int j = i; j < i + 1000; ++j)
        dx += (std::cos(j * 2e-5) + 0.3 * std::cos(j * 7e-5)) * 1e-6;
      exact = loop_mm(exact, dx, d, gamma);
    }
    EXPECT_NEAR(exact, z, 2e-5) << gamma;
  }
}

TEST(Hysteresis, ForgetsInAirAndStartsEmptyWhenARecordingBeginsInContact) {
  const ForceTermPtr term =
      make_force_term("hysteresis", {{"alpha_n_per_mm", 0.5}, {"d_mm", 0.1}}, "test");
  TermMemory memory{};
  EXPECT_EQ(term->evaluate(pressed(0.3, 0.0), memory).tissue_n, 0.0);
  EXPECT_GT(term->evaluate(pressed(0.4), memory).tissue_n, 0.0);
  EXPECT_EQ(term->evaluate(TermInput{}, memory).tissue_n, 0.0);
  EXPECT_EQ(memory, TermMemory{});
}

TEST(Backlash, TheTipIsBehindByItsPlayBothWays) {
  const ForceTermPtr term = make_force_term("backlash", {{"b_mm", 0.05}}, "test");
  EXPECT_NEAR(after(*term, {0.3}, 40), -0.8 * 0.05, 1e-14);
  EXPECT_NEAR(after(*term, {0.3, 0.25}, 40), 0.0, 1e-14);        // 0.05 of 0.1 mm of play taken up
  EXPECT_NEAR(after(*term, {0.3, 0.1}, 40), 0.8 * 0.05, 1e-14);  // all of it
  EXPECT_NEAR(after(*term, {0.03}, 40), -0.8 * 0.03,
              1e-14);  // not yet moved: no force of the tooth at all
  EXPECT_NEAR(after(*make_force_term("backlash", {{"b_mm", 0.05}, {"ahead_mm", 0.0}}, "test"),
                    {0.3, 0.1}, 40),
              0.0, 1e-14);
}

TEST(Backlash, WhereContactIsSeenAtTheDriveTheTipStartsAboveTheSurface) {
  const ForceTermPtr term = make_force_term("backlash", {{"b_mm", 0.05}, {"seen", 1.0}}, "test");
  TermMemory memory{};
  (void)term->evaluate(TermInput{}, memory);  // air takes the play up
  EXPECT_NEAR(term->evaluate(pressed(0.02), memory).tissue_n, -0.8 * 0.05,
              1e-14);  // tip at -0.03 mm
}

TEST(Backlash, StepsDoNotMatter) {
  const ForceTermPtr term = make_force_term("backlash", {{"b_mm", 0.02}}, "test");
  EXPECT_EQ(after(*term, {0.3, 0.29, 0.5}, 1), after(*term, {0.3, 0.29, 0.5}, 1000));
}

}  // namespace
}  // namespace cavum
