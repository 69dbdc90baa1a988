// The inverse of a small square matrix, for the linear models of a class.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace cavum::cohort {

using SquareMatrix = std::vector<std::vector<double>>;

/// Gauss and Jordan with the largest pivot, rows of any scale. Nothing when the rows depend on one another, to 1 in 10¹⁰.
[[nodiscard]] inline std::optional<SquareMatrix> inverted(SquareMatrix a) {
  const std::size_t n = a.size();
  SquareMatrix b(n, std::vector<double>(n));
  std::vector<double> scale(n);
  for (std::size_t i = 0; i < n; ++i) {
    b[i][i] = 1;
    for (const double v : a[i]) scale[i] = std::max(scale[i], std::fabs(v));
  }
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t p = c;
    for (std::size_t r = c + 1; r < n; ++r)
      if (std::fabs(a[r][c]) * scale[p] > std::fabs(a[p][c]) * scale[r]) p = r;
    if (!(std::fabs(a[p][c]) > 1e-10 * scale[p])) return std::nullopt;
    std::swap(a[p], a[c]);
    std::swap(b[p], b[c]);
    std::swap(scale[p], scale[c]);
    for (std::size_t r = 0; r < n; ++r) {
      const double f = r == c ? 0 : a[r][c] / a[c][c];
      if (f == 0) continue;
      for (std::size_t k = 0; k < n; ++k) {
        a[r][k] -= f * a[c][k];
        b[r][k] -= f * b[c][k];
      }
    }
  }
  for (std::size_t r = 0; r < n; ++r)
    for (double& v : b[r]) v /= a[r][r];
  return b;
}

}  // namespace cavum::cohort
