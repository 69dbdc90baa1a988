// The Falcon's mechanism against a second solution: the nine equations of its loops, in other
// unknowns and in long double, and three spheres.
#include "engine/device/hardware/falcon_kinematics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using Real = long double;
using testing_basics::drawn_seed;

/// Walks along the links: origin, motor, knee, link, shin (a parallelogram turned by `swing` in the
/// arm's plane and leaning by `lean` out of it), link, grip. Nine unknowns: swing and lean of each
/// arm, and the grip's place; nine equations: each arm ends at the grip. Newton with differences in
/// long double.
std::optional<Vec3> by_loops(const FalconGeometry& g, const FalconAngles& angles) {
  std::array<Real, 9> x{};
  for (std::size_t arm = 0; arm < 3; ++arm) {
    x[2 * arm] = 2.2L;      // swing: from the knee inwards and up
    x[2 * arm + 1] = 1.5L;  // lean
  }
  x[8] = 110.0L;
  const auto equations = [&](const std::array<Real, 9>& at) {
    std::array<Real, 9> left{};
    for (std::size_t arm = 0; arm < 3; ++arm) {
      const Real leg = g.leg_rad[arm], thigh = angles[arm], swing = at[2 * arm],
                 lean = at[2 * arm + 1];
      const Real in_plane = static_cast<Real>(g.links) + static_cast<Real>(g.b) * sinl(lean);
      const Real u = g.r + g.a * cosl(thigh) + in_plane * cosl(swing) - g.c;
      const Real v = g.s + g.b * cosl(lean) - g.f;
      const Real w = g.a * sinl(thigh) + in_plane * sinl(swing);
      left[3 * arm] = u * cosl(leg) - v * sinl(leg) - at[6];
      left[3 * arm + 1] = u * sinl(leg) + v * cosl(leg) - at[7];
      left[3 * arm + 2] = w - at[8];
    }
    return left;
  };
  for (int round = 0; round < 100; ++round) {
    const auto left = equations(x);
    std::array<std::array<Real, 10>, 9> m{};
    for (std::size_t column = 0; column < 9; ++column) {
      auto more = x, less = x;
      const Real h = column < 6 ? 1e-6L : 1e-4L;
      more[column] += h;
      less[column] -= h;
      const auto a = equations(more), b = equations(less);
      for (std::size_t row = 0; row < 9; ++row) m[row][column] = (a[row] - b[row]) / (2 * h);
    }
    for (std::size_t row = 0; row < 9; ++row) m[row][9] = -left[row];
    for (std::size_t pivot = 0; pivot < 9; ++pivot) {
      std::size_t best = pivot;
      for (std::size_t row = pivot + 1; row < 9; ++row)
        if (fabsl(m[row][pivot]) > fabsl(m[best][pivot])) best = row;
      std::swap(m[pivot], m[best]);
      if (fabsl(m[pivot][pivot]) < 1e-9L) return std::nullopt;
      for (std::size_t row = 0; row < 9; ++row) {
        if (row == pivot) continue;
        const Real share = m[row][pivot] / m[pivot][pivot];
        for (std::size_t column = pivot; column < 10; ++column)
          m[row][column] -= share * m[pivot][column];
      }
    }
    Real size = 0;
    for (std::size_t i = 0; i < 9; ++i) {
      const Real step = m[i][9] / m[i][i];
      x[i] += std::clamp(step, i < 6 ? -0.2L : -15.0L, i < 6 ? 0.2L : 15.0L);
      size += fabsl(step);
    }
    if (size < 1e-15L) break;
    if (round == 99 && size > 1e-9L) return std::nullopt;
  }
  return Vec3{static_cast<double>(x[6]), static_cast<double>(x[7]), static_cast<double>(x[8])};
}

/// Without short links each knee is the centre of a sphere of the shin's length on which the grip
/// lies: their meeting in closed form.
Vec3 by_spheres(const FalconGeometry& g, const FalconAngles& angles) {
  std::array<std::array<Real, 3>, 3> k{};
  for (std::size_t arm = 0; arm < 3; ++arm) {
    const Real leg = g.leg_rad[arm], u = g.r + g.a * cosl(angles[arm]) - g.c,
               v = static_cast<Real>(g.s) - g.f;
    k[arm] = {u * cosl(leg) - v * sinl(leg), u * sinl(leg) + v * cosl(leg),
              g.a * sinl(static_cast<Real>(angles[arm]))};
  }
  const auto minus = [](auto p, auto q) {
    return std::array<Real, 3>{p[0] - q[0], p[1] - q[1], p[2] - q[2]};
  };
  const auto times = [](auto p, auto q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; };
  auto ex = minus(k[1], k[0]);
  const Real d = sqrtl(times(ex, ex));
  for (Real& e : ex) e /= d;
  const auto to_third = minus(k[2], k[0]);
  const Real i = times(ex, to_third);
  std::array<Real, 3> ey{to_third[0] - i * ex[0], to_third[1] - i * ex[1], to_third[2] - i * ex[2]};
  const Real j = sqrtl(times(ey, ey));
  for (Real& e : ey) e /= j;
  const std::array<Real, 3> ez{ex[1] * ey[2] - ex[2] * ey[1], ex[2] * ey[0] - ex[0] * ey[2],
                               ex[0] * ey[1] - ex[1] * ey[0]};
  const Real x = d / 2, y = (i * i + j * j) / (2 * j) - i * x / j, b = g.b;
  Real z = sqrtl(b * b - x * x - y * y);
  if (ez[2] < 0) z = -z;
  std::array<double, 3> p{};
  for (std::size_t n = 0; n < 3; ++n)
    p[n] = static_cast<double>(k[0][n] + x * ex[n] + y * ey[n] + z * ez[n]);
  return {p[0], p[1], p[2]};
}

/// A place within the 80 mm that its maker names, in front of the motors.
Vec3 drawn_place(std::mt19937_64& random) {
  std::uniform_real_distribution<double> off(-40.0, 40.0);
  return k_falcon_middle_mm + Vec3{off(random), off(random), off(random)};
}

TEST(FalconKinematics, PlaceAgreesWithTheNineLoopEquations) {
  std::mt19937_64 random(drawn_seed("FalconKinematics"));
  const FalconGeometry g;
  int compared = 0;
  double worst_mm = 0.0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 place = drawn_place(random);
    FalconAngles angles{};
    if (!falcon_angles(g, place, angles)) continue;  // a corner of the cube
    Vec3 found = k_falcon_middle_mm;
    ASSERT_TRUE(falcon_position(g, angles, found));
    EXPECT_LT(length(found - place), 1e-8) << "there and back";
    const auto other = by_loops(g, angles);
    if (!other) continue;  // Newton's method from afar need not arrive
    ++compared;
    worst_mm = std::max(worst_mm, length(found - *other));
  }
  EXPECT_GT(compared, 250);
  EXPECT_LT(worst_mm, 1e-8) << "1e-11 m, of 1e-6 m asked for";
  std::printf("%d places, largest difference %.1e mm\n", compared, worst_mm);
}

TEST(FalconKinematics, WithoutLinksItIsThreeSpheres) {
  std::mt19937_64 random(drawn_seed("FalconKinematics"));
  FalconGeometry g;
  g.b += g.links;  // about the same reach
  g.links = 0.0;
  int compared = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 place = drawn_place(random);
    FalconAngles angles{};
    if (!falcon_angles(g, place, angles)) continue;
    Vec3 found = k_falcon_middle_mm;
    ASSERT_TRUE(falcon_position(g, angles, found));
    const Vec3 other = by_spheres(g, angles);
    EXPECT_LT(length(found - other), 1e-9);
    ++compared;
  }
  EXPECT_GT(compared, 800);
}

TEST(FalconKinematics, JacobianIsTheDifferenceOfPlaces) {
  std::mt19937_64 random(drawn_seed("FalconKinematics"));
  const FalconGeometry g;
  for (int i = 0; i < 300; ++i) {
    const Vec3 place = drawn_place(random);
    FalconAngles angles{};
    if (!falcon_angles(g, place, angles)) continue;
    std::array<Vec3, 3> columns;
    ASSERT_TRUE(falcon_jacobian(g, angles, place, columns));
    constexpr double h = 1e-5;
    for (std::size_t arm = 0; arm < 3; ++arm) {
      FalconAngles more = angles, less = angles;
      more[arm] += h;
      less[arm] -= h;
      Vec3 a = place, b = place;
      ASSERT_TRUE(falcon_position(g, more, a) && falcon_position(g, less, b));
      EXPECT_LT(length((a - b) / (2 * h) - columns[arm]), 1e-4 * (1 + length(columns[arm])));
    }
  }
}

TEST(FalconKinematics, TheHandsWorkIsTheArmsWork) {
  std::mt19937_64 random(drawn_seed("FalconKinematics"));
  std::normal_distribution<double> any;
  const FalconGeometry g;
  for (int i = 0; i < 300; ++i) {
    const Vec3 place = drawn_place(random);
    FalconAngles angles{};
    std::array<Vec3, 3> columns;
    if (!falcon_angles(g, place, angles) || !falcon_jacobian(g, angles, place, columns)) continue;
    const Vec3 force{any(random), any(random), any(random)},
        way = Vec3{any(random), any(random), any(random)} * 1e-4;
    FalconAngles there{}, back{};
    ASSERT_TRUE(falcon_angles(g, place + way, there) && falcon_angles(g, place - way, back));
    const auto torques = falcon_torques_nmm(columns, force);
    double work_of_arms = 0.0;
    for (std::size_t arm = 0; arm < 3; ++arm)
      work_of_arms += torques[arm] * (there[arm] - back[arm]) / 2;
    EXPECT_NEAR(work_of_arms, dot(force, way), 1e-9) << "N·mm";
  }
}

TEST(FalconKinematics, OutOfReachIsSaid) {
  const FalconGeometry g;
  FalconAngles angles{};
  EXPECT_FALSE(falcon_angles(g, {0, 0, 400}, angles));
  EXPECT_FALSE(falcon_angles(g, {300, 0, 100}, angles));
  Vec3 at = k_falcon_middle_mm;
  FalconGeometry short_shins = g;
  short_shins.b = 15.0;
  short_shins.links = 0.0;
  EXPECT_FALSE(falcon_position(short_shins, {0.3, 0.3, 0.3}, at));
  EXPECT_FALSE(falcon_position(g, {std::nan(""), 0.3, 0.3}, at));
  EXPECT_EQ(at, k_falcon_middle_mm);
}

}  // namespace
}  // namespace cavum
