#include "engine/lab/explain/recording/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

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
  for (Eigen::Index i = 0; i < e.size(); ++i)
    e[i] = (i > 0 ? rho * e[i - 1] : 0.0) + sd * std::sqrt(1 - rho * rho) * random.normal();
  return e;
}

TEST(Noise, ScatterAndMemoryAreFoundAboutTheMeanOfEachSession) {
  const Recording r = rows(40000);
  for (const double rho : {0.0, 0.5, 0.9}) {
    Series e = remembering(r, rho, 0.03);
    e.head(20000) += 0.4;
    const Noise n = estimate_noise(r, e, Series::Ones(r.rows()));
    EXPECT_NEAR(n.rho, rho, 0.03);
    EXPECT_NEAR(n.sd_n, 0.03, 0.003);
    // a share of 0.1 counts as white, so the predictor of one row is rho/1.1, and the next ones
    // help a little
    EXPECT_GT(n.step_sd_n, 0.999 * 0.03 * std::sqrt(1 - rho * rho) - 1e-4);
    EXPECT_LT(n.step_sd_n, 0.03 * std::sqrt(1 - 2 * rho * rho / 1.1 + rho * rho / 1.21) + 1e-3);
  }
}

TEST(Noise, AnEffectThatIsStillThereMakesItLargerAndNeverSmaller) {
  const Recording r = rows(40000);
  const Series e = remembering(r, 0.5, 0.03);
  const Series with = e + 0.2 * (0.3 * r.t_s).sin();
  const Series ones = Series::Ones(r.rows());
  EXPECT_GT(estimate_noise(r, with, ones).sd_n, estimate_noise(r, e, ones).sd_n);
  EXPECT_GE(estimate_noise(r, with, ones).step_sd_n, 0.999 * estimate_noise(r, e, ones).step_sd_n);
}

/// A swing e_i = 2 q cos(w) e_(i-1) - q² e_(i-2) + u: its coefficients are known, and so is its
/// variance.
Series swinging(const Recording& r, double q, double w, double step_sd) {
  Random random(9);
  Series e = Series::Zero(r.rows());
  for (Eigen::Index i = 2; i < e.size(); ++i)
    e[i] = 2 * q * std::cos(w) * e[i - 1] - q * q * e[i - 2] + step_sd * random.normal();
  return e;
}

TEST(Noise, ASwingIsFoundWithItsCoefficients) {
  const Recording r = rows(60000);
  const Noise n = estimate_noise(r, swinging(r, 0.95, 0.4, 0.01), Series::Ones(r.rows()));
  ASSERT_GE(n.ar.size(), 2u);
  // |1 - sum phi z^-j|² is smallest where it swings
  std::complex<double> near = 1.0, far = 1.0;
  for (std::size_t j = 0; j < n.ar.size(); ++j) {
    near -= n.ar[j] * std::polar(1.0, -0.4 * static_cast<double>(j + 1));
    far -= n.ar[j] * std::polar(1.0, -1.6 * static_cast<double>(j + 1));
  }
  EXPECT_LT(std::norm(near), 0.05 * std::norm(far));
  EXPECT_GT(n.step_sd_n, 0.0099);
  EXPECT_LT(n.step_sd_n, 0.02);  // the swing itself has 0.059
}

TEST(Noise, WhitenedRowsAreIndependentWithVarianceOne) {
  const Recording r = rows(40000);
  const Series ones = Series::Ones(r.rows());
  std::vector<std::pair<Series, Noise>> all{
      {remembering(r, 0.8, 0.03), {0.8, 0.03, 0.03 * 0.6, {}}}};
  for (Series e : {remembering(r, 0.0, 0.03), remembering(r, 0.5, 0.03)})
    all.emplace_back(e, estimate_noise(r, e, ones));
  for (auto& [z, noise] : all) {
    Whitening(r, noise, ones, {}).apply(z);
    const Eigen::Index n = z.size();
    EXPECT_NEAR(z.square().mean(), 1.0, 0.03);
    for (const Eigen::Index lag : {1, 2, 7, 30})
      EXPECT_NEAR((z.head(n - lag) * z.tail(n - lag)).mean(), 0.0, 0.06) << lag;
  }
}

TEST(Noise, TheFirstRowsOfASessionHaveTheVarianceOfTheOthers) {
  const double q = 0.95, w = 0.4, step = 0.01;
  const Noise noise{0.0, 0.0, step, {2 * q * std::cos(w), -q * q}};
  Recording r = rows(20);
  const Whitening white(r, noise, Series::Ones(r.rows()), {});
  // the process itself has, by Yule and Walker, variance (1 + q²)/((1 - q²)(1 - 2 q² cos 2w + q⁴))
  // step²
  const double variance =
      step * step * (1 + q * q) / ((1 - q * q) * (1 - 2 * q * q * std::cos(2 * w) + q * q * q * q));
  EXPECT_NEAR(white.root_weight()[0], 1.0 / std::sqrt(variance), 1e-9 / std::sqrt(variance));
  EXPECT_NEAR(white.root_weight()[5], 1.0 / step, 1e-9 / step);
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
