#include "engine/base/statistics.h"

#include <cmath>
#include <numeric>
#include <utility>

namespace cavum {

double mean(std::span<const double> values) noexcept {
  return values.empty() ? 0.0
                        : std::accumulate(values.begin(), values.end(), 0.0) /
                              static_cast<double>(values.size());
}

double variance(std::span<const double> values) noexcept {
  if (values.size() < 2) return 0.0;
  const double middle = mean(values);
  double squares = 0.0;
  for (const double v : values) squares += (v - middle) * (v - middle);
  return squares / static_cast<double>(values.size() - 1);
}

double correlation(std::span<const double> a, std::span<const double> b) noexcept {
  const double ma = mean(a), mb = mean(b);
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - ma) * (b[i] - mb);
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0.0;
}

double normal_cdf(double z) noexcept { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

// Summed in shares, unlike mean(): the figures that the rigs have published are of this sum, to the
// last bit.
MeanSd mean_sd(std::span<const double> values) noexcept {
  MeanSd out;
  const auto n = static_cast<double>(values.size());
  for (const double v : values) out.mean += v / n;
  if (values.size() < 2) return out;
  double squares = 0.0;
  for (const double v : values) squares += (v - out.mean) * (v - out.mean);
  out.sd = std::sqrt(squares / (n - 1.0));
  return out;
}

Fit fit_columns(std::span<const std::vector<double>> columns, std::span<const double> y) noexcept {
  Fit fit;
  const std::size_t p = columns.size(), n = y.size();
  if (p == 0 || p > k_fit_columns || n < p) return fit;
  // normal equations beside the identity: Gauss-Jordan turns them into the inverse
  std::array<std::array<double, 2 * k_fit_columns>, k_fit_columns> m{};
  std::array<double, k_fit_columns> right{};
  for (std::size_t i = 0; i < p; ++i) {
    m[i][p + i] = 1.0;
    for (std::size_t r = 0; r < n; ++r) {
      right[i] += columns[i][r] * y[r];
      for (std::size_t j = 0; j < p; ++j) m[i][j] += columns[i][r] * columns[j][r];
    }
  }
  const auto before = m;
  for (std::size_t i = 0; i < p; ++i) {
    std::size_t best = i;
    for (std::size_t r = i + 1; r < p; ++r)
      if (std::fabs(m[r][i]) > std::fabs(m[best][i])) best = r;
    std::swap(m[i], m[best]);
    if (!(std::fabs(m[i][i]) > 1e-10 * (1e-300 + std::fabs(before[i][i])))) return fit;
    const double pivot = m[i][i];
    for (auto& v : m[i]) v /= pivot;
    for (std::size_t r = 0; r < p; ++r) {
      if (r == i) continue;
      const double f = m[r][i];
      for (std::size_t j = 0; j < 2 * p; ++j) m[r][j] -= f * m[i][j];
    }
  }
  for (std::size_t i = 0; i < p; ++i)
    for (std::size_t j = 0; j < p; ++j) fit.value[i] += m[i][p + j] * right[j];
  double squares = 0.0;
  for (std::size_t r = 0; r < n; ++r) {
    double e = y[r];
    for (std::size_t i = 0; i < p; ++i) e -= fit.value[i] * columns[i][r];
    squares += e * e;
  }
  fit.rms = std::sqrt(squares / static_cast<double>(n));
  const double variance = n > p ? squares / static_cast<double>(n - p) : 0.0;
  for (std::size_t i = 0; i < p; ++i)
    fit.error[i] = std::sqrt(std::fmax(0.0, variance * m[i][p + i]));
  fit.solved = true;
  return fit;
}

}  // namespace cavum
