#include "engine/base/det_math.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(DetMath, AgreesWithLibmTo1e12) {
  Random random(drawn_seed("DetMath.AgreesWithLibmTo1e12"));
  const auto check = [](double angle) {
    const SinCos s = det_sincos(angle);
    ASSERT_NEAR(s.sin, std::sin(angle), 1e-12) << angle;
    ASSERT_NEAR(s.cos, std::cos(angle), 1e-12) << angle;
    ASSERT_NEAR(s.sin * s.sin + s.cos * s.cos, 1.0, 2e-12) << angle;
  };
  for (int i = 0; i < 20000; ++i) check(random.uniform(-10, 10));
  for (int i = 0; i < 20000; ++i) check(random.uniform(-1e6, 1e6));
  for (int quarter = -16; quarter <= 16; ++quarter)  // where the quadrant changes
    for (const double beside : {-1e-9, 0.0, 1e-9}) check((quarter + 0.5) * k_pi / 2 + beside);
}

TEST(DetMath, ExpAndTanhAgreeWithLibmTo1e12) {
  Random random(drawn_seed("DetMath.ExpAndTanhAgreeWithLibmTo1e12"));
  const auto check_exp = [](double x) { ASSERT_NEAR(det_exp(x) / std::exp(x), 1.0, 1e-12) << x; };
  const auto check_tanh = [](double x) {
    ASSERT_NEAR(det_tanh(x), std::tanh(x), 1e-12) << x;
    if (x != 0) {
      ASSERT_NEAR(det_tanh(x) / std::tanh(x), 1.0, 1e-12) << x;
    }
    ASSERT_EQ(det_tanh(-x), -det_tanh(x)) << x;
    ASSERT_LE(std::fabs(det_tanh(x)), 1.0) << x;
  };
  for (int i = 0; i < 20000; ++i) {
    check_exp(random.uniform(-700, 700));
    check_exp(random.uniform(-1, 1));
    check_tanh(random.uniform(-25, 25));
    check_tanh(random.uniform(-1, 1));
    check_tanh(random.uniform(-1e-6, 1e-6));
  }
  for (const double seam : {0.0, 0.6, 20.0})  // where the method changes
    for (const double beside : {-1e-9, 0.0, 1e-9}) check_tanh(seam + beside);
  for (const double x : {1e-300, 1e300, static_cast<double>(INFINITY)}) check_tanh(x);
  EXPECT_EQ(det_exp(0.0), 1.0);
}

TEST(DetMath, TanhNeverFalls) {  // a friction law must not: the search for its speed relies on it
  double last = -1.0;
  for (int i = -250000; i <= 250000; ++i) {
    const double t = det_tanh(i * 1e-4);
    ASSERT_GE(t, last - 1e-15) << i;
    last = t;
  }
}

TEST(DetMath, DirectionsAgreeWithTheLibrary) {
  constexpr double k_deg = 180 / k_pi;
  for (double t = -20; t < 20; t += 0.037)
    EXPECT_NEAR(atan_deg(t), std::atan(t) * k_deg, 1e-8) << t;
  for (double angle = -179.9; angle < 180; angle += 0.37) {
    const auto [sin, cos] = det_sincos(angle / k_deg);
    EXPECT_NEAR(direction_deg(7 * cos, 7 * sin), angle, 1e-8);
  }
  EXPECT_EQ(direction_deg(0, 2), 90);
  EXPECT_EQ(direction_deg(0, -2), -90);
  EXPECT_EQ(direction_deg(-1, 0), 180);
  EXPECT_EQ(direction_deg(0, 0), 0);
}

TEST(DetMath, IsKnownWhileCompiling) {
  static_assert(det_exp(0.0) == 1.0 && det_tanh(0.0) == 0.0);
  static_assert(det_sincos(0.0).sin == 0.0 && det_sincos(0.0).cos == 1.0);
  static_assert(det_sincos(k_pi / 6).sin > 0.4999999999 && det_sincos(k_pi / 6).sin < 0.5000000001);
}

}  // namespace
}  // namespace cavum
