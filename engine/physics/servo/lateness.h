// How late the ticks of a real-time loop started: a histogram in steps of 1-2-5, so that a rare
// tenth of a second shows beside the usual ten microseconds. Counting allocates nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace cavum {

struct Lateness {
  /// Upper edges of the bins, µs; the last bin has none.
  static constexpr std::array<std::int64_t, 16> k_edges_us{
      1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000};

  std::array<std::int64_t, k_edges_us.size() + 1> counts{};
  std::int64_t ticks = 0, worst_ns = 0, sum_ns = 0;

  void add(std::int64_t late_ns) noexcept {
    late_ns = std::max<std::int64_t>(0, late_ns);
    const auto at =
        std::lower_bound(k_edges_us.begin(), k_edges_us.end(), late_ns,
                         [](std::int64_t edge, std::int64_t ns) { return edge * 1000 < ns; });
    ++counts[static_cast<std::size_t>(at - k_edges_us.begin())];
    ++ticks;
    sum_ns += late_ns;
    worst_ns = std::max(worst_ns, late_ns);
  }
  [[nodiscard]] double mean_us() const noexcept {
    return ticks > 0 ? static_cast<double>(sum_ns) * 1e-3 / static_cast<double>(ticks) : 0.0;
  }
  [[nodiscard]] double worst_us() const noexcept { return static_cast<double>(worst_ns) * 1e-3; }
  /// Upper edge, µs, of the bin that the given share of all ticks does not exceed; the worst one
  /// for the last bin.
  [[nodiscard]] double quantile_us(double share) const noexcept {
    double seen = 0;
    for (std::size_t i = 0; i < k_edges_us.size(); ++i)
      if ((seen += static_cast<double>(counts[i])) >= share * static_cast<double>(ticks))
        return std::min(static_cast<double>(k_edges_us[i]), worst_us());
    return worst_us();
  }
};

}  // namespace cavum
