#include "engine/lab/explain/recording/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/lab/explain/recording/as_recorded.h"

namespace cavum::explain {
namespace {

Recording path(double dt_s, double length_s, double quantum_mm,
               const std::function<double(double)>& x) {
  Recording r;
  const auto n = static_cast<Eigen::Index>(length_s / dt_s);
  r.t_s = Series::LinSpaced(n, 0.0, dt_s * static_cast<double>(n - 1));
  r.x_mm = r.t_s.unaryExpr(
      [&](double t) { return quantum_mm > 0 ? quantum_mm * std::round(x(t) / quantum_mm) : x(t); });
  r.f_n = Series::Zero(n);
  r.sessions = {{"1", 0, n}};
  r.rig.position_quantum_mm = quantum_mm;
  return r;
}

TEST(Motion, SpeedAndAccelerationOfASineAreItsDerivatives) {
  const double w = 2.0;
  const Motion m =
      estimate_motion(path(0.005, 20, 0, [&](double t) { return 0.5 * std::sin(w * t); }));
  for (Eigen::Index i = 200; i < 3800; i += 97) {
    const double t = 0.005 * static_cast<double>(i);
    EXPECT_NEAR(m.v_mm_s[i], 0.5 * w * std::cos(w * t), 1e-3);
    EXPECT_NEAR(m.a_mm_s2[i], -0.5 * w * w * std::sin(w * t), 0.02);
  }
}

TEST(Motion, ARampThroughACoarseEncoderKeepsItsSpeed) {
  const Motion m = estimate_motion(path(0.005, 8, 0.055, [](double t) { return 0.25 * t - 0.3; }));
  for (Eigen::Index i = 100; i < 1500; i += 50) {
    EXPECT_NEAR(m.v_mm_s[i], 0.25, 0.01);
    EXPECT_NEAR(m.x_mm[i], 0.25 * 0.005 * static_cast<double>(i) - 0.3, 0.004);
  }
}

TEST(Motion, StatedScatterIsLikeTheErrorForStopsInACoarseEncoder) {
  // ramps of 0.25 mm/s between holds at places that do not fit the encoder
  const auto x = [](double t) {
    const double cycle = std::fmod(t, 8.0), start = 0.0137 * std::floor(t / 8.0);
    return start + (cycle < 2   ? 0.25 * cycle
                    : cycle < 4 ? 0.5
                    : cycle < 6 ? 0.5 - 0.25 * (cycle - 4)
                                : 0.0);
  };
  const Recording r = path(0.005, 160, 0.055, x);
  const Motion m = estimate_motion(r);
  const Series error = m.x_mm - r.t_s.unaryExpr(x);
  const double rms = std::sqrt(error.square().mean()),
               stated = std::sqrt(m.sd_x_mm.square().mean());
  EXPECT_LT(rms, 0.055 / std::sqrt(12.0));  // better than the reading itself
  EXPECT_GT(stated, 0.5 * rms);
  EXPECT_LT(stated, 2.0 * rms);
}

TEST(Motion, FinePositionsLeaveLittleDoubtOfTheSpeedEvenWhereItTurns) {
  // 30 mm/s to and fro, 3 mm/s more in every row where it turns: friction's sign needs the speed to
  // a tenth of a millimetre per second there
  const double w = 20.0;
  const Recording r = path(0.005, 20, 0, [&](double t) { return 30.0 / w * std::sin(w * t); });
  const Motion m = estimate_motion(r);
  const Eigen::Index inner = r.rows() - 200;
  const double error =
      std::sqrt((m.v_mm_s - 30.0 * (w * r.t_s).cos()).segment(100, inner).square().mean());
  const double said = std::sqrt(m.sd_v_mm_s.segment(100, inner).square().mean());
  EXPECT_GT(said, error);
  EXPECT_LT(said, 10.0 * error);
  EXPECT_LT(said, 0.01);
}

TEST(Motion, WhereTheSpeedJumpsItIsDoubted) {
  const Recording r =
      path(0.005, 20, 0, [](double t) { return 3.0 * std::fabs(std::fmod(t, 1.0) - 0.5); });
  const Motion m = estimate_motion(r);
  EXPECT_GT(m.sd_v_mm_s[300], 0.3) << "the turn at 1.5 s";
  EXPECT_LT(m.sd_v_mm_s[350], 0.01) << "half a stroke later";
}

TEST(Motion, AQuantumNobodyStatedIsSeen) {
  Recording r =
      path(0.005, 20, 0.01, [](double t) { return 0.3 * std::sin(t) + 0.1 * std::sin(0.37 * t); });
  r.rig.position_quantum_mm = 0.0;
  EXPECT_NEAR(seen_quantum_mm(r), 0.01, 1e-6);
  EXPECT_EQ(seen_quantum_mm(path(0.005, 20, 0, [](double t) { return 0.3 * std::sin(t); })), 0.0);
}

}  // namespace
}  // namespace cavum::explain
