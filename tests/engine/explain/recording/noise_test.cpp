#include "engine/explain/recording/noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random.h"

namespace cavum::explain {
namespace {

Recording rows(Eigen::Index n) {
  Recording r;
  r.t_s = Series::LinSpaced(n, 0, 0.005 * static_cast<double>(n - 1));
  r.x_mm = r.f_n = Series::Zero(n);
  r.sessions = {{"1", 0, n / 2}, {"2", n / 2, n}};
  return r;
}

Series remembering(const Recording& r, double rho, double sd) {
  Random random(7);
  Series e(r.rows());
  for (Eigen::Index i = 0; i < e.size(); ++i) e[i] = (i > 0 ? rho * e[i - 1] : 0.0) + sd * std::sqrt(1 - rho * rho) * random.normal();
  return e;
}

TEST(Noise, ScatterAndMemoryAreFoundAlsoUnderASlowEffect) {
  const Recording r = rows(40000);
  for (const double rho : {0.0, 0.5, 0.9}) {
    Series e = remembering(r, rho, 0.03);
    e += 0.2 * (0.3 * r.t_s).sin() + 0.1;
    const Noise n = estimate_noise(r, e, Series::Ones(r.rows()));
    EXPECT_NEAR(n.rho, rho, 0.03);
    EXPECT_NEAR(n.sd_n, 0.03, 0.003);
  }
}

TEST(Noise, WhitenedRowsAreIndependentWithVarianceOne) {
  const Recording r = rows(40000);
  Series z = remembering(r, 0.8, 0.03);
  const Whitening white(r, {0.8, 0.03, 0.03 * 0.6}, Series::Ones(r.rows()), {});
  white.apply(z);
  const Eigen::Index n = z.size();
  EXPECT_NEAR(z.square().mean(), 1.0, 0.03);
  EXPECT_NEAR((z.head(n - 1) * z.tail(n - 1)).mean(), 0.0, 0.02);
}

TEST(Noise, ABlowWeighsLittle) {
  Series z = Series::LinSpaced(101, -1, 1);
  z[50] = 100.0;
  const Series w = robust_weights(z);
  EXPECT_EQ(w[10], 1.0);
  EXPECT_LT(w[50], 0.05);
}

}  // namespace
}  // namespace cavum::explain
