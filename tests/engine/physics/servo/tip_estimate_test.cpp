#include "engine/physics/servo/tip_estimate.h"

#include <gtest/gtest.h>

#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

constexpr double k_quantum_mm = 0.055;

double encoded(double mm) { return std::floor(mm / k_quantum_mm + 0.5) * k_quantum_mm; }
std::array<std::int32_t, 3> reading(Vec3 mm) {
  return make_tick_input({{encoded(mm.x), encoded(mm.y), encoded(mm.z)}, {}}, 0, k_stylus_fresh, 0,
                         {})
      .tip_nm;
}

/// A tip that is read through the encoder.
struct Read {
  double dt_s = 0.001;
  TipEstimate state = make_tip_estimate({});
  std::int64_t tick = 0;

  Vec3 at(Vec3 mm) {
    update_tip_estimate(state, reading(mm), ++tick, k_quantum_mm, dt_s);
    return state.tip_mm;
  }
  [[nodiscard]] double fastest(Vec3 direction) const {
    return fastest_mm_s(state, direction, tick, k_quantum_mm, dt_s);
  }
};

TEST(TipEstimate, IsTheTruePlaceAtConstantSpeed) {
  for (const double dt : {0.001, 0.00025})
    for (const double v : {0.02, 0.1, 0.25, 1.0, 5.0, -0.25}) {
      Read read{dt};
      const double settled_s = 3 * k_quantum_mm / std::fabs(v),
                   jitter_mm = 2 * std::fabs(v) * dt;  // a step is seen up to a tick late
      double worst = 0;
      for (double t = dt; t < 4 * settled_s; t += dt) {
        const double x = v * t, seen = read.at({x, 0, 0}).x;
        if (t > settled_s) worst = std::max(worst, std::fabs(seen - x));
      }
      EXPECT_LE(worst, jitter_mm + 1e-6) << v << " mm/s, dt " << dt;
    }
}

TEST(TipEstimate, StaysWithinHalfAQuantumOfTheReadingAndAQuantumOfTheTruth) {
  Random random(drawn_seed("TipEstimate.StaysWithinHalfAQuantumOfTheReadingAndAQuantumOfTheTruth"));
  Read read;
  Vec3 at, speed;
  for (int i = 0; i < 20000; ++i) {
    if (i % 200 == 0) speed = random_direction(random) * random.uniform(0, 60);
    at += speed * 0.001;
    const Vec3 s = read.at(at);
    for (const auto& [estimate, truth] : {std::pair{s.x, at.x}, {s.y, at.y}, {s.z, at.z}}) {
      ASSERT_LE(std::fabs(estimate - encoded(truth)), 0.5 * k_quantum_mm + 2e-6) << i;
      ASSERT_LE(std::fabs(estimate - truth), k_quantum_mm + 2e-6) << i;
    }
  }
}

TEST(TipEstimate, AFlickerOverABorderDoesNotMoveIt) {
  Read read;
  for (int i = 0; i < 20; ++i)
    (void)read.at({0.02 + 0.0005 * i, 0, 0});  // over the border at 0.0275
  const double before = read.at({0.026, 0, 0}).x;
  EXPECT_NEAR(before, 0.0275, 1e-6);
  for (int i = 0; i < 200; ++i) ASSERT_NEAR(read.at({i % 3 ? 0.027 : 0.028, 0, 0}).x, before, 1e-6);
}

TEST(TipEstimate, IsTheReadingItselfWithoutAQuantum) {
  Random random(drawn_seed("TipEstimate.IsTheReadingItselfWithoutAQuantum"));
  TipEstimate state = make_tip_estimate({});
  for (int i = 1; i < 2000; ++i) {
    const TickInput in = make_tick_input(
        {{random.uniform(-9, 9), random.uniform(-9, 9), i % 2 ? 1.5 : random.uniform(-9, 9)}, {}},
        0, k_stylus_fresh, 0, {});
    update_tip_estimate(state, in.tip_nm, i, 0.0, 0.001);
    const Vec3 tip = in.pose().tip_mm;
    ASSERT_TRUE(state.tip_mm.x == tip.x && state.tip_mm.y == tip.y && state.tip_mm.z == tip.z);
  }
  EXPECT_TRUE(std::isinf(fastest_mm_s(state, {0, 0, 1}, 2000, 0.0, 0.001)))
      << "an exact device bounds nothing";
}

TEST(TipEstimate, TheFastestSpeedLeavesConstantSpeedsAloneAndFallsWhenAStepIsOverdue) {
  for (const double v : {0.05, 0.25, 2.0, 10.0}) {
    Read read;
    const Vec3 way = normalized(Vec3{1, -2, 2}), start{0.001, 0.002, 0.003};
    int i = 0;
    const int settled = static_cast<int>(9 * k_quantum_mm / (v * 0.001));
    for (; i < 3 * settled; ++i) {
      (void)read.at(start + way * (v * 0.001 * i));
      if (i > settled) {
        ASSERT_GE(read.fastest(way), v) << i << " at " << v;
      }
    }
    double last = read.fastest(way);
    const Vec3 rest = start + way * (v * 0.001 * i);
    for (int n = 0; n < 20000; ++n) {
      (void)read.at(rest);
      if (n == 0) last = read.fastest(way);  // a step may still have come
      ASSERT_LE(read.fastest(way), last);
      last = read.fastest(way);
    }
    EXPECT_LE(last, 0.1 * k_quantum_mm) << "20 s at rest";
  }
}

/// A tooth pressed straight down, its surface at z = 0.
Rig pressed(double quantum_mm, double dt_s) {
  Rig rig(make_block({6, 6, 6}, {{"dentin", 6.0}}, 0.05), {shipped_bur("round-1.0")},
          hard_model(0.8, 2 * std::sqrt(0.8)), {0, 0, 0.1}, dt_s);
  rig.model.config.position_quantum_mm = quantum_mm;
  rig.model.config.limits = {.peak_n = 100, .continuous_n = 100, .slew_n_per_s = 1e5};
  return rig;
}

TEST(TipEstimate, ThroughAnEncoderARampIsRenderedWithin2PercentOfTheLawAndWithoutSteps) {
  for (const double dt : {0.001, 0.00025}) {
    Rig rig = pressed(k_quantum_mm, dt);
    constexpr double k_speed = 0.25, c = 1.7888543819998317;
    double worst = 0, largest_change = 0, last = 0;
    for (double t = dt; t < 14; t += dt) {
      const double z = 0.1 - k_speed * t;
      const double f = rig.tick({0, 0, encoded(z)}, 0).rendered_force_n.z;
      if (t > 12) {
        worst = std::max(worst, std::fabs(f / (0.8 * -z + c * k_speed) - 1));
        largest_change = std::max(largest_change, std::fabs(f - last));
      }
      last = f;
    }
    std::printf(
        "encoder of 0.055 mm, 0.25 mm/s, dt %g: off the Voigt law by at most %.4f; largest change in a tick %.5f N\n",
        dt, worst, largest_change);
    EXPECT_LE(worst, 0.02);
    EXPECT_LE(largest_change, 0.003) << "a step of the encoder alone would be 0.0825 N";
  }
}

TEST(TipEstimate, AtRestTheForceIsTheSpringWithinASecond) {
  Rig rig = pressed(k_quantum_mm, 0.001);
  (void)rig.travel({0, 0, 0.11}, {0, 0, -1.1}, 5.0);  // a multiple of the quantum
  TickOutput out;
  for (int i = 0; i < 1000; ++i) out = rig.tick({0, 0, -1.1}, 0);
  EXPECT_NEAR(out.rendered_force_n.z / (0.8 * out.penetration_mm), 1.0, 0.01)
      << "with c/Kvc = 2.6 s alone it would be 1.6";
  EXPECT_NEAR(out.penetration_mm, 1.1, 0.5 * k_quantum_mm + 1e-3);
}

TEST(TipEstimate, AQuarterOfTheTickGivesTheSamePhysicsThroughAnEncoder) {
  double force[2], rest[2];
  int n = 0;
  for (const double dt : {0.001, 0.00025}) {
    Rig rig = pressed(k_quantum_mm, dt);
    double sum = 0;
    int count = 0;
    for (double t = dt; t < 5; t += dt) {  // in, with changing speed, and rest
      const double z = 0.1 - (t < 3 ? 0.4 * t + 0.1 * std::sin(3 * t) : 1.2 + 0.1 * std::sin(9.0));
      const TickOutput out = rig.tick({0, 0, encoded(z)}, 0);
      if (t > 1 && t < 3) sum += out.rendered_force_n.z, ++count;
      rest[n] = out.rendered_force_n.z;
    }
    force[n++] = sum / count;
  }
  EXPECT_NEAR(force[1] / force[0], 1, 0.01);
  EXPECT_NEAR(rest[1] / rest[0], 1, 0.01);
}

}  // namespace
}  // namespace cavum
