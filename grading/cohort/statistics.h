// What the marks of a class say of the exam itself: how hard and how telling each criterion is, how
// reliable the sum, how well it agrees with people, where to draw the line, and whether one station
// grades harder than another. Plain arithmetic and square roots; chances by permutation, not by
// tables.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/statistics.h"

namespace cavum::cohort {

/// Rows of equal length: persons by criteria, or objects by judges. Functions throw Error when it
/// is too small or ragged.
using Matrix = std::vector<std::vector<double>>;

using cavum::correlation;
using cavum::mean;
using cavum::variance;

/// alpha = k/(k-1)·(1 - sum of the criteria's variances / variance of the sum). Cronbach,
/// Psychometrika 16 (1951) 297.
[[nodiscard]] double cronbach_alpha(std::size_t criteria, double sum_of_variances,
                                    double variance_of_sum);
[[nodiscard]] double cronbach_alpha(const Matrix& persons_by_criteria);
/// Standard error of one person's sum: s·sqrt(1 - alpha).
[[nodiscard]] double standard_error(double sd_of_sum, double alpha);
/// Of each criterion with the sum of the others.
[[nodiscard]] std::vector<double> discrimination(const Matrix& persons_by_criteria);

/// Intraclass correlations of objects by judges, two-way: Shrout and Fleiss, Psychological Bulletin
/// 86 (1979) 420.
struct Icc {
  double single_random = 0,
         single_fixed = 0;  ///< ICC(2,1): absolute agreement of one judge; ICC(3,1): consistency
  double average_random = 0, average_fixed = 0;  ///< ICC(2,k), ICC(3,k)
};
[[nodiscard]] Icc intraclass_correlation(const Matrix& objects_by_judges);

/// kappa_w = 1 - sum(w·observed)/sum(w·expected), w = weight of a disagreement, 0 on the diagonal.
/// Cohen, Psychological Bulletin 70 (1968) 213. `counts`: square table of both judges' categories.
[[nodiscard]] double weighted_kappa(const Matrix& counts, const Matrix& weights);
/// Weights |i - j|^2 for n categories.
[[nodiscard]] Matrix quadratic_weights(std::size_t n);

/// Differences a - b: Bland and Altman, Lancet 327 (1986) 307.
struct LimitsOfAgreement {
  double bias = 0, sd = 0;
  double low = 0, high = 0;  ///< bias -+ 2 sd
};
[[nodiscard]] LimitsOfAgreement limits_of_agreement(std::span<const double> a,
                                                    std::span<const double> b);

/// Least squares y = intercept + slope·x.
struct Line {
  double intercept = 0, slope = 0, r = 0;
};
[[nodiscard]] Line fit_line(std::span<const double> x, std::span<const double> y);
/// Borderline regression: the score that the line of scores over examiners' global ratings gives at
/// the rating that means borderline.
[[nodiscard]] double borderline_cut(std::span<const double> rating, std::span<const double> score,
                                    double borderline);

/// Groups of scores, one for each station: F = between/within, and the chance that shuffled scores
/// give as much, by `shuffles` permutations.
struct GroupEffect {
  double f = 0, chance = 1;
  double share = 0;  ///< of the variance: eta squared
};
[[nodiscard]] GroupEffect group_effect(const std::vector<std::vector<double>>& groups, int shuffles,
                                       std::uint64_t seed);

}  // namespace cavum::cohort
