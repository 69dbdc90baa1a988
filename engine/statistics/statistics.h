// The little statistics of the rigs: mean and scatter, and least squares with up to three columns and the
// standard error of each coefficient.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace cavum {

struct MeanSd {
  double mean = 0.0, sd = 0.0;  ///< sd with n - 1; 0 for a single value
};
[[nodiscard]] MeanSd mean_sd(std::span<const double> values) noexcept;

inline constexpr std::size_t k_fit_columns = 3;

struct Fit {
  std::array<double, k_fit_columns> value{}, error{};  ///< coefficient of each column, and its standard error
  double rms = 0.0;                                    ///< of the residuals
  bool solved = false;                                 ///< false: columns depend on one another, or fewer values than columns
};
/// Least squares of `y` on columns of the same length, at most three.
[[nodiscard]] Fit fit_columns(std::span<const std::vector<double>> columns, std::span<const double> y) noexcept;

}  // namespace cavum
