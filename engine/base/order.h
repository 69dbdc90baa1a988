// Values by their place in order: median and quantiles. Each is one of the values themselves, never
// a mean of two, so that whole numbers stay whole and every machine gives the same.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace cavum {

/// The value that `before` others stand before in order, 0 <= before < values.size().
template <class T>
[[nodiscard]] T in_order(std::vector<T> values, std::size_t before) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(before);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The one in the middle, the upper one of two. Of one value at least.
template <class T>
[[nodiscard]] T median(std::vector<T> values) {
  const std::size_t half = values.size() / 2;
  return in_order(std::move(values), half);
}

/// Place of the value below which `share` (0..1) of n >= 1 values lie: share·(n − 1), rounded down.
[[nodiscard]] inline std::size_t quantile_index(std::size_t n, double share) noexcept {
  return static_cast<std::size_t>(share * static_cast<double>(n - 1));
}

/// Value below which `share` (0..1) of the values lie. Of one value at least.
template <class T>
[[nodiscard]] T quantile(std::vector<T> values, double share) {
  const std::size_t place = quantile_index(values.size(), share);
  return in_order(std::move(values), place);
}

/// The same of values that are in order already.
[[nodiscard]] inline double quantile_of_sorted(std::span<const double> sorted,
                                               double share) noexcept {
  return sorted[quantile_index(sorted.size(), share)];
}

}  // namespace cavum
