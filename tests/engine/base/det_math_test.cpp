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

TEST(DetMath, IsKnownWhileCompiling) {
  static_assert(det_sincos(0.0).sin == 0.0 && det_sincos(0.0).cos == 1.0);
  static_assert(det_sincos(k_pi / 6).sin > 0.4999999999 && det_sincos(k_pi / 6).sin < 0.5000000001);
}

}  // namespace
}  // namespace cavum
