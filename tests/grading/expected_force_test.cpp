#include "grading/expected_force.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cavum {
namespace {

/// Frames of a tip that moves along -z at `speed(t)` (mm/s, positive = deeper) against a spring of k N/mm whose foot recedes at X / tau.
std::vector<DrillFrame> against_a_spring(double k, double tau_s, double seconds, double (*speed)(double)) {
  std::vector<DrillFrame> frames;
  double depth = 0, x = 0;
  for (double t = 0; t < seconds; t += k_frame_s) {
    const double step = speed(t) * k_frame_s;
    depth += step;
    x = x + step - std::max(0.0, x) * k_frame_s / tau_s;
    DrillFrame f;
    f.tip_mm = {0, 0, -depth};
    f.force_n = {0, 0, k * std::max(0.0, x)};
    f.handle = {0, 0, 1};
    frames.push_back(f);
  }
  return frames;
}

double least_share(const std::vector<DrillFrame>& frames, ExpectedForce& observer) {
  double least = 1;
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(frames.size()); ++i) {
    observer.take(frames, i);
    if (observer.ready() && observer.expected_n() > 0.05) least = std::min(least, observer.force_n() / observer.expected_n());
  }
  return least;
}

TEST(ExpectedForce, LearnsTheStiffnessOfASpring) {
  for (const double k : {0.4, 0.8, 1.2}) {
    ExpectedForce observer({});
    const auto frames = against_a_spring(k, 2.02, 8, [](double t) { return 0.4 + 0.4 * std::sin(6 * t); });
    (void)least_share(frames, observer);
    EXPECT_NEAR(observer.stiffness_n_per_mm(), k, 0.15);
  }
}

TEST(ExpectedForce, ExplainsWhatTheHandDoesInSolidTissue) {
  // feeds, pauses until the cut has caught up, feeds again, backs off slowly, lifts
  ExpectedForce observer({});
  const auto frames = against_a_spring(0.8, 2.02, 14, [](double t) {
    if (t < 4) return 0.4;
    if (t < 7) return 0.0;
    if (t < 11) return 0.4;
    return t < 12 ? -0.3 : -10.0;
  });
  EXPECT_GT(least_share(frames, observer), 0.7);
}

TEST(ExpectedForce, HoldsOnToTheForceThatGoesWithoutTheTipGivingWay) {
  auto frames = against_a_spring(0.8, 2.02, 5, [](double) { return 0.4; });
  for (std::size_t i = frames.size() - 30; i < frames.size(); ++i) frames[i].force_n = {};
  ExpectedForce observer({});
  (void)least_share(frames, observer);
  EXPECT_GT(observer.expected_n(), 0.8 * 0.4 * 0.8 * 2.02);
  EXPECT_LT(observer.force_n(), 0.01);
  EXPECT_NEAR(observer.out().z, 1, 1e-6);
}

}  // namespace
}  // namespace cavum
