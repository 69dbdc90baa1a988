// Each figure against a published worked example, to the printed digits.
#include "grading/cohort/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/error.h"

namespace cavum::cohort {
namespace {

TEST(CohortStatistics, IntraclassCorrelationsAreThoseOfShroutAndFleiss) {
  // Psychological Bulletin 86 (1979) 420, tables 2 and 4: six targets, four judges
  const Icc icc = intraclass_correlation(
      {{9, 2, 5, 8}, {6, 1, 3, 2}, {8, 4, 6, 8}, {7, 1, 2, 6}, {10, 5, 6, 9}, {6, 2, 4, 7}});
  EXPECT_NEAR(icc.single_random, 0.29, 0.005);
  EXPECT_NEAR(icc.single_fixed, 0.71, 0.005);
  EXPECT_NEAR(icc.average_random, 0.62, 0.005);
  EXPECT_NEAR(icc.average_fixed, 0.91, 0.005);
}

TEST(CohortStatistics, WeightedKappaIsThatOfCohen) {
  // Psychological Bulletin 70 (1968) 213, table 1: two judges, three diagnoses, weights of
  // disagreement 0 1 3 / 1 0 6 / 3 6 0
  const Matrix table = {{0.44, 0.07, 0.09}, {0.05, 0.20, 0.05}, {0.01, 0.03, 0.06}};
  EXPECT_NEAR(weighted_kappa(table, {{0, 1, 3}, {1, 0, 6}, {3, 6, 0}}), 0.348, 0.0005);
  EXPECT_NEAR(weighted_kappa(table, {{0, 1, 1}, {1, 0, 1}, {1, 1, 0}}), 0.492, 0.0005);
  EXPECT_EQ(quadratic_weights(3), (Matrix{{0, 1, 4}, {1, 0, 1}, {4, 1, 0}}));
}

TEST(CohortStatistics, LimitsOfAgreementAreThoseOfBlandAndAltman) {
  // Lancet 327 (1986) 307: peak expiratory flow by Wright's meter and the mini meter, 17 subjects
  const std::vector<double> wright = {494, 395, 516, 434, 476, 557, 413, 442, 650,
                                      433, 417, 656, 267, 478, 178, 423, 427};
  const std::vector<double> mini = {512, 430, 520, 428, 500, 600, 364, 380, 658,
                                    445, 432, 626, 260, 477, 259, 350, 451};
  const LimitsOfAgreement l = limits_of_agreement(wright, mini);
  EXPECT_NEAR(l.bias, -2.1, 0.05);
  EXPECT_NEAR(l.sd, 38.8, 0.05);
  EXPECT_NEAR(l.low, -79.7, 0.1);
  EXPECT_NEAR(l.high, 75.5, 0.1);
}

TEST(CohortStatistics, AlphaIsThatOfBlandAndAltman) {
  // BMJ 314 (1997) 572: mini-HAQ, ten items, variances 11.16 in sum, 77.44 of the total
  EXPECT_NEAR(cronbach_alpha(10, 11.16, 77.44), 0.95, 0.005);
  // and the table's own way: items that are equal are wholly reliable, unrelated ones not at all
  EXPECT_NEAR(cronbach_alpha({{1, 1, 1}, {2, 2, 2}, {5, 5, 5}}), 1.0, 1e-12);
  EXPECT_NEAR(cronbach_alpha({{0, 0}, {0, 1}, {1, 0}, {1, 1}}), 0.0, 1e-12);
  EXPECT_NEAR(standard_error(8.8, 0.91), 8.8 * 0.3, 1e-12);
}

TEST(CohortStatistics, LinesAreThoseOfAnscombe) {
  // The American Statistician 27 (1973) 17: y = 3.00 + 0.500 x, r = 0.816
  const std::vector<double> x = {10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5},
                            y = {8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68};
  const Line line = fit_line(x, y);
  EXPECT_NEAR(line.intercept, 3.00, 0.005);
  EXPECT_NEAR(line.slope, 0.500, 0.0005);
  EXPECT_NEAR(line.r, 0.816, 0.0005);
  EXPECT_NEAR(borderline_cut(x, y, 9.0), 7.50, 0.005)
      << "the line goes through both means, 9.0 and 7.50";
}

TEST(CohortStatistics, GroupsDifferAsTheReferenceDataSay) {
  // NIST statistical reference datasets, SiRstv: resistivity of silicon by five instruments;
  // certified F = 1.18046237440255
  const std::vector<std::vector<double>> g = {{196.3052, 196.1240, 196.1890, 196.2569, 196.3403},
                                              {196.3042, 196.3825, 196.1669, 196.3257, 196.0422},
                                              {196.1303, 196.2005, 196.2889, 196.0343, 196.1811},
                                              {196.2795, 196.1748, 196.1494, 196.1485, 195.9885},
                                              {196.2119, 196.1051, 196.1850, 196.0052, 196.2090}};
  const GroupEffect e = group_effect(g, 9999, 1);
  EXPECT_NEAR(e.f, 1.18046237440255, 1e-8);
  EXPECT_NEAR(e.share, 0.190999039051129, 1e-9) << "certified R squared";
  EXPECT_NEAR(e.chance, 0.3494, 0.03) << "F(4, 20) has 0.349 beyond it";
  auto harder = g;
  for (double& v : harder[2]) v -= 0.5;
  EXPECT_LT(group_effect(harder, 9999, 1).chance, 0.001);
}

TEST(CohortStatistics, ACriterionThatTellsNothingDoesNotDiscriminate) {
  const Matrix m = {{1, 1, 1}, {2, 2, 0}, {3, 3, 1}, {4, 4, 0}};
  const auto d = discrimination(m);
  EXPECT_NEAR(d[0], 0.894427, 1e-6) << "2 of sqrt(5): by hand";
  EXPECT_NEAR(d[1], 0.894427, 1e-6);
  EXPECT_NEAR(d[2], -0.447214, 1e-6) << "-2 of sqrt(20): by hand";
}

TEST(CohortStatistics, TooLittleIsSaid) {
  EXPECT_THROW(static_cast<void>(cronbach_alpha(Matrix{{1, 2}})), Error);
  EXPECT_THROW(static_cast<void>(cronbach_alpha(Matrix{{1, 2}, {1}})), Error);
  EXPECT_THROW(static_cast<void>(cronbach_alpha(Matrix{{1, 2}, {1, 2}})), Error) << "all alike";
  EXPECT_THROW(static_cast<void>(weighted_kappa({{5, 0}, {0, 0}}, quadratic_weights(2))), Error);
  EXPECT_THROW(static_cast<void>(group_effect({{1.0, 2.0}}, 10, 1)), Error);
  EXPECT_THROW(static_cast<void>(fit_line(std::vector<double>{1, 1}, std::vector<double>{1, 2})),
               Error);
}

}  // namespace
}  // namespace cavum::cohort
