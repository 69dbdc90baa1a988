#include "engine/physics/contact/half_spaces.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

double worst_violation(const std::vector<HalfSpace>& set, Vec3 s) {
  double worst = -1e9;
  for (const auto& h : set) worst = std::max(worst, -h.slack_mm - dot(h.normal, s));
  return worst;
}

/// The nearest allowed place among all projections onto one, two and three planes: what an optimum
/// must be.
std::optional<Vec3> brute_force(Vec3 wanted, const std::vector<HalfSpace>& set, double tolerance) {
  std::optional<Vec3> best;
  const auto consider = [&](Vec3 s) {
    if (!is_finite(s) || worst_violation(set, s) > tolerance) return;
    if (!best || length(s - wanted) < length(*best - wanted)) best = s;
  };
  consider(wanted);
  const std::size_t n = set.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = set[i].normal;
    const double fa = -set[i].slack_mm;
    consider(wanted + a * ((fa - dot(a, wanted)) / dot(a, a)));
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vec3 b = set[j].normal, along = cross(a, b);
      const double fb = -set[j].slack_mm;
      if (dot(along, along) < 1e-18) continue;
      const Vec3 on_both = (cross(b, along) * fa + cross(along, a) * fb) / dot(along, along);
      consider(on_both + along * (dot(along, wanted - on_both) / dot(along, along)));
      for (std::size_t k = j + 1; k < n; ++k) {
        const Vec3 c = set[k].normal;
        const double det = dot(a, cross(b, c));
        if (std::fabs(det) < 1e-12) continue;
        consider((cross(b, c) * fa + cross(c, a) * fb - cross(a, b) * set[k].slack_mm) / det);
      }
    }
  }
  return best;
}

TEST(HalfSpaces, StepIsTheNearestAllowedOneOfAllCandidates) {
  Random random(drawn_seed("HalfSpaces.StepIsTheNearestAllowedOneOfAllCandidates"));
  int blocked = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<HalfSpace> set;
    const Vec3 allowed = random_direction(random) * random.uniform(0, 0.05);
    for (auto n = 1 + random.below(12); n > 0; --n) {
      const Vec3 normal = random_direction(random) * random.uniform(0.9, 1.1);
      set.push_back(
          {normal,
           std::max(random.uniform(-0.02, 0.05),
                    1e-5 - dot(normal, allowed))});  // keeps `allowed` allowed, and 10 nm around it
    }
    const Vec3 wanted = random_direction(random) * random.uniform(0, 0.1);
    const auto solution = nearest_step(wanted, set);
    const auto expected = brute_force(wanted, set, 1e-9);
    ASSERT_TRUE(expected.has_value());
    ASSERT_TRUE(solution.feasible) << "round " << round;
    ASSERT_LE(worst_violation(set, solution.step), 1e-8);
    ASSERT_NEAR(length(solution.step - wanted), length(*expected - wanted), 1e-7)
        << "round " << round;
    ASSERT_LE(length(solution.step - *expected), 1e-4) << "round " << round;
    blocked += length(solution.step - wanted) > 1e-6;
  }
  EXPECT_GT(blocked, 1000) << "the random sets hardly ever block";
}

TEST(HalfSpaces, NearlyParallelPlanesOfAFlatSurfaceStayExact) {
  Random random(drawn_seed("HalfSpaces.NearlyParallelPlanesOfAFlatSurfaceStayExact"));
  int unsolved = 0;
  double worst = 0, too_long = 0;
  for (int round = 0; round < 5000; ++round) {
    const Vec3 out = random_direction(random);
    const double bend = std::pow(
        10.0,
        random.uniform(-5, -1.5));  // rounding of the distance codes, to a slightly curved wall
    std::vector<HalfSpace> set;
    for (auto n = 3 + random.below(10); n > 0; --n)
      set.push_back({normalized(out + random_direction(random) * bend),
                     random.uniform(-0.001, 0.002) * std::min(1.0, bend * 100)});
    for (auto n = random.below(4); n > 0;
         --n) {  // nearly the same once more, as a refinement finds it
      HalfSpace again = set[random.below(set.size())];
      again.normal += random_direction(random) * random.uniform(0, 0.1 * bend);
      again.slack_mm += random.uniform(-1, 1) * std::pow(10.0, random.uniform(-16, -6));
      set.push_back(again);
    }
    const Vec3 wanted = out * random.uniform(-0.25, 0) + random_direction(random) * 0.01;
    const auto solution = nearest_step(wanted, set);
    const auto expected = brute_force(wanted, set, 1e-9);
    if (!expected) continue;
    if (!solution.feasible) {
      ++unsolved;
      continue;
    }
    worst = std::max(worst, worst_violation(set, solution.step));
    too_long = std::max(too_long, length(solution.step - wanted) - length(*expected - wanted));
  }
  std::printf(
      "nearly parallel: unsolved %d of 5000, worst violation %.2g mm, longer than the best by %.2g mm\n",
      unsolved, worst, too_long);
  EXPECT_EQ(unsolved, 0);
  EXPECT_LE(worst, 1e-6);
  EXPECT_LE(too_long, 1e-5);
}

TEST(HalfSpaces, ContradictingHalfSpacesAreToldApart) {
  const std::vector<HalfSpace> squeezed{{{0, 0, 1}, -0.01}, {{0, 0, -1}, -0.01}};
  EXPECT_FALSE(nearest_step({0, 0, 0}, squeezed).feasible);
  const std::vector<HalfSpace> slit{{{0, 0, 1}, 0.01}, {{0, 0, -1}, 0.01}};
  const auto s = nearest_step({0.3, -0.2, 5}, slit);
  EXPECT_TRUE(s.feasible);
  EXPECT_LE(length(s.step - Vec3{0.3, -0.2, 0.01}), 1e-9);
}

TEST(HalfSpaces, NothingInTheWayGivesTheWantedStep) {
  EXPECT_EQ(nearest_step({1, 2, 3}, {}).step, (Vec3{1, 2, 3}));
}

}  // namespace
}  // namespace cavum
