// The little statistics of rigs, reports and cohorts: mean and scatter, correlation, the normal
// distribution, and least squares with up to three columns and the standard error of each
// coefficient. Medians and quantiles: order.h.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace cavum {

/// Sum over n; 0 of no value.
[[nodiscard]] double mean(std::span<const double> values) noexcept;
/// Of a sample: over n - 1; 0 of fewer than two values.
[[nodiscard]] double variance(std::span<const double> values) noexcept;
/// Product-moment correlation of two samples of the same length; 0 when either does not vary.
[[nodiscard]] double correlation(std::span<const double> a, std::span<const double> b) noexcept;
/// Chance that a normal deviate is below z. By the library's erfc, whose last bits differ between
/// machines: it explains, it does not mark.
[[nodiscard]] double normal_cdf(double z) noexcept;

struct MeanSd {
  double mean = 0.0, sd = 0.0;  ///< sd with n - 1; 0 for a single value
};
[[nodiscard]] MeanSd mean_sd(std::span<const double> values) noexcept;

inline constexpr std::size_t k_fit_columns = 3;

struct Fit {
  std::array<double, k_fit_columns> value{},
      error{};          ///< coefficient of each column, and its standard error
  double rms = 0.0;     ///< of the residuals
  bool solved = false;  ///< false: columns depend on one another, or fewer values than columns
};
/// Least squares of `y` on columns of the same length, at most three.
[[nodiscard]] Fit fit_columns(std::span<const std::vector<double>> columns,
                              std::span<const double> y) noexcept;

}  // namespace cavum
