#include "grading/perforation/expected_force.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cavum::grading {
namespace {

/// Frames of a tip that moves along -z at `speed(t)` (mm/s, positive = deeper) against a spring of
/// k N/mm whose foot recedes at X / tau.
std::vector<DrillFrame> against_a_spring(double k, double tau_s, double seconds,
                                         double (*speed)(double)) {
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
    if (observer.ready() && observer.expected_n() > 0.05)
      least = std::min(least, observer.force_n() / observer.expected_n());
  }
  return least;
}

double learned(double k) {
  ExpectedForce observer({});
  (void)least_share(
      against_a_spring(k, 2.02, 8, [](double t) { return 0.4 + 1.2 * std::sin(6 * t); }), observer);
  return observer.stiffness_n_per_mm();
}

TEST(ExpectedForce, LearnsTheStiffnessOfASpring) {
  for (const double k : {0.65, 0.8, 1.15}) EXPECT_NEAR(learned(k), k, 0.1);
}

TEST(ExpectedForce, TakesNoSpringForHardTissueThatIsSofterOrStiffer) {
  EXPECT_DOUBLE_EQ(learned(0.2), ExpectedForceSettings{}.least_stiffness_n_per_mm);
  EXPECT_DOUBLE_EQ(learned(2.5), ExpectedForceSettings{}.most_stiffness_n_per_mm);
}

TEST(ExpectedForce, GrowsWithTheWayOfATipThatPressesOnInAFall) {
  const double k = 0.8, tau_s = 2.02, lunge_mm = 0.5;
  auto frames = against_a_spring(k, tau_s, 8, [](double) { return 0.4; });
  ExpectedForceSettings settings;
  settings.worth_mm2 = 1e6;  // k is known
  ExpectedForce observer(settings);
  (void)least_share(frames, observer);
  EXPECT_DOUBLE_EQ(observer.pressed_n(), observer.expected_n()) << "nothing is missing yet";
  const double level = observer.level_n();
  // the force goes, and the tip springs on within 0.1 s
  const auto first = static_cast<std::int64_t>(frames.size());
  const int count = 10;
  for (int i = 1; i <= count; ++i) {
    DrillFrame f = frames[static_cast<std::size_t>(first - 1)];
    f.tip_mm.z -= lunge_mm * i / count;
    f.force_n = {};
    frames.push_back(f);
  }
  for (int i = 0; i < 3; ++i)
    frames.push_back(frames.back());  // until the means over three frames have arrived
  for (std::int64_t i = first; i < static_cast<std::int64_t>(frames.size()); ++i)
    observer.take(frames, i);
  EXPECT_LE(observer.expected_n(), level + 1e-12) << "the level bounds what was only guessed";
  // F = k X of a surface that recedes at X / tau
  const double decay = std::exp(-(count + 3) * k_frame_s / tau_s);
  EXPECT_NEAR(observer.pressed_n(), level * decay + k * lunge_mm * (1 + decay) / 2, 0.04 * level);
  for (int i = 0; i < 30; ++i) {
    frames.push_back(frames.back());
    frames.back().tip_mm.z -= 0.5;
    observer.take(frames, static_cast<std::int64_t>(frames.size()) - 1);
  }
  EXPECT_NEAR(observer.pressed_n(), settings.pressed_most * observer.level_n(), 1e-9);
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
}  // namespace cavum::grading
