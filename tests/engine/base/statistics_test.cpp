#include "engine/base/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random.h"
#include "engine/lab/rig/published.h"

namespace cavum {
namespace {

TEST(Statistics, MeanAndScatterOfKnownNumbers) {
  const MeanSd m = mean_sd(std::vector<double>{2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_DOUBLE_EQ(m.mean, 5.0);
  EXPECT_NEAR(m.sd, std::sqrt(32.0 / 7.0), 1e-12);
  EXPECT_EQ(mean_sd(std::vector<double>{3}).sd, 0.0);
}

TEST(Statistics, TooFewValuesHaveNoScatter) {
  EXPECT_EQ(mean({}), 0.0);
  EXPECT_EQ(variance(std::vector<double>{3}), 0.0);
  EXPECT_EQ(mean_sd({}).sd, 0.0);
}

/// The American Statistician 27 (1973) 17: mean 9 and 7.50, variance 11, r = 0.816.
TEST(Statistics, MomentsAreThoseOfAnscombe) {
  const std::vector<double> x = {10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5},
                            y = {8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68};
  EXPECT_EQ(mean(x), 9.0);
  EXPECT_NEAR(mean(y), 7.50, 0.005);
  EXPECT_DOUBLE_EQ(variance(x), 11.0);
  EXPECT_NEAR(correlation(x, y), 0.816, 0.0005);
  EXPECT_EQ(correlation(x, std::vector<double>(x.size(), 2.0)), 0.0) << "one that does not vary";
}

TEST(Statistics, TheNormalDistributionIsTheTables) {
  EXPECT_DOUBLE_EQ(normal_cdf(0.0), 0.5);
  EXPECT_NEAR(normal_cdf(1.959964), 0.975, 1e-6);
  EXPECT_NEAR(normal_cdf(-2.575829), 0.005, 1e-6);
}

TEST(Statistics, FitFindsTheCoefficientsThatMadeTheData) {
  std::vector<std::vector<double>> columns(3);
  std::vector<double> y;
  for (int i = 0; i <= 6; ++i) {
    const double k = 0.2 * i;
    columns[0].push_back(k);
    columns[1].push_back(1);
    columns[2].push_back(std::sqrt(k));
    y.push_back(0.505 * k + 0.26 + 0.5 * std::sqrt(k));
  }
  const Fit fit = fit_columns(columns, y);
  ASSERT_TRUE(fit.solved);
  EXPECT_NEAR(fit.value[0], 0.505, 1e-9);
  EXPECT_NEAR(fit.value[1], 0.26, 1e-9);
  EXPECT_NEAR(fit.value[2], 0.5, 1e-9);
  EXPECT_LT(fit.rms, 1e-9);
}

/// The error of a slope in closed form: s/√Σ(x - x̄)².
TEST(Statistics, StandardErrorOfALineIsTheTextbooks) {
  Random random(5);
  std::vector<std::vector<double>> columns(2);
  std::vector<double> y;
  for (int i = 0; i < 40; ++i) {
    columns[0].push_back(0.1 * i);
    columns[1].push_back(1);
    y.push_back(2.0 * 0.1 * i + 1.0 + 0.3 * random.normal());
  }
  const Fit fit = fit_columns(columns, y);
  double squares = 0, spread = 0;
  for (std::size_t i = 0; i < 40; ++i) {
    const double e = y[i] - fit.value[0] * columns[0][i] - fit.value[1];
    squares += e * e;
    spread += (columns[0][i] - 1.95) * (columns[0][i] - 1.95);
  }
  EXPECT_NEAR(fit.error[0], std::sqrt(squares / 38 / spread), 1e-12);
  EXPECT_LT(std::fabs(fit.value[0] - 2.0), 4 * fit.error[0]);
}

TEST(Statistics, DependentColumnsAndTooFewValuesAreNotSolved) {
  const std::vector<std::vector<double>> same{{1, 2, 3}, {2, 4, 6}};
  EXPECT_FALSE(fit_columns(same, std::vector<double>{1, 2, 3}).solved);
  const std::vector<std::vector<double>> few{{1}, {1}};
  EXPECT_FALSE(fit_columns(few, std::vector<double>{1}).solved);
}

TEST(Published, FormulaeGiveThePapersNumbers) {
  EXPECT_NEAR(paper_damping_n_s_per_mm(0.8), 1.79, 0.005);
  EXPECT_NEAR(paper_stiffness_n_per_mm(k_paper_tooth_n), 0.789, 0.002);
  EXPECT_NEAR(consistent_damping_n_s_per_mm(0.8, 0.045), 0.012, 1e-6);
  EXPECT_NEAR(paper_force_n(paper_stiffness_n_per_mm(1.0)), 1.0, 1e-12);
}

}  // namespace
}  // namespace cavum
