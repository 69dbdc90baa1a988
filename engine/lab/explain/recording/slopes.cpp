#include "engine/lab/explain/recording/slopes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/order.h"

namespace cavum::explain {
namespace {

constexpr std::size_t k_near = 3;  // rows on each side of which the largest difference counts
// The difference of the two orders above over that of the two below: 0.2 where the acceleration
// jumps, 0.4 where the speed does, less where neither.
constexpr double k_smooth = 0.18, k_no_jump = 0.3;
// What five and seven differ by on most rows is what the positions' last digit does, unless all the
// motion is jerks.
constexpr double k_times_usual = 4.0, k_usual_most = 0.01,
                 k_min_mm_s = 1e-9;  // the second of the root mean square speed
constexpr double k_times_high = 1.5,
                 k_times_low = 2.0;  // 1.0 and 1.8 is what the speed was off by, at most

/// Derivative at `at` of the polynomial through points [from, from + count): Lagrange's basis,
/// differentiated at one of its own points.
double slope_of_polynomial(std::span<const double> t, std::span<const double> x, std::size_t from,
                           std::size_t count, std::size_t at) {
  double slope = 0.0;
  for (std::size_t j = from; j < from + count; ++j) {
    if (j == at) continue;
    double weight = 1.0 / (t[j] - t[at]);
    for (std::size_t m = from; m < from + count; ++m)
      if (m != j && m != at) weight *= (t[at] - t[m]) / (t[j] - t[m]);
    slope += weight * (x[j] - x[at]);
  }
  return slope;
}

}  // namespace

std::vector<Slope> slopes(std::span<const double> t_s, std::span<const double> x_mm) {
  const std::size_t n = t_s.size();
  if (n < 7) return std::vector<Slope>(n, {0.0, std::numeric_limits<double>::infinity()});
  std::vector<double> low(n), high(n);
  std::vector<Slope> out(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto slope = [&](std::size_t count) {
      return slope_of_polynomial(t_s, x_mm, std::min(i > count / 2 ? i - count / 2 : 0, n - count),
                                 count, i);
    };
    const double five = slope(5);
    out[i].mm_s = five;
    low[i] = std::fabs(slope(3) - five);
    high[i] = std::fabs(five - slope(7));
  }
  double square = 0.0;
  for (std::size_t i = 1; i < n; ++i)
    square +=
        std::pow((x_mm[i] - x_mm[i - 1]) / (t_s[i] - t_s[i - 1]), 2.0) / static_cast<double>(n);
  const double usual = std::max(
      k_min_mm_s, std::min(k_times_usual * median(high), k_usual_most * std::sqrt(square)));
  for (std::size_t i = 0; i < n; ++i) {
    const auto from = static_cast<std::ptrdiff_t>(i > k_near ? i - k_near : 0),
               to = static_cast<std::ptrdiff_t>(std::min(n, i + k_near + 1));
    const double first = *std::max_element(low.begin() + from, low.begin() + to),
                 second = *std::max_element(high.begin() + from, high.begin() + to);
    out[i].error_mm_s = second < std::max(usual, k_smooth * first) ? k_times_high * second
                        : second < k_no_jump * first               ? k_times_low * first
                                                     : std::numeric_limits<double>::infinity();
  }
  return out;
}

}  // namespace cavum::explain
