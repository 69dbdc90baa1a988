// How regularly something comes: count, mean period, scatter and longest gap, from the moments at
// which it came. One thread counts, any may ask.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>

namespace cavum {

class PeriodMeter {
 public:
  /// It came at `now_ns`, on a clock that never goes back. Counting thread only.
  void add(std::int64_t now_ns) noexcept {
    if (last_ns_ != 0) {
      const auto period_ns = static_cast<double>(now_ns - last_ns_);
      ++periods_;
      const double off = period_ns - mean_ns_;  // Welford: no large sums cancel
      mean_ns_ += off / static_cast<double>(periods_);
      square_ns2_ += off * (period_ns - mean_ns_);
      mean_s_.store(mean_ns_ * 1e-9, std::memory_order_relaxed);
      scatter_s_.store(1e-9 * std::sqrt(std::max(0.0, square_ns2_) / static_cast<double>(periods_)),
                       std::memory_order_relaxed);
      longest_s_.store(std::max(longest_s_.load(std::memory_order_relaxed), period_ns * 1e-9),
                       std::memory_order_relaxed);
    }
    last_ns_ = now_ns;
    count_.fetch_add(1, std::memory_order_relaxed);
  }
  /// The next one begins anew: the time since the last is no period. Counting thread only.
  void pause() noexcept { last_ns_ = 0; }

  [[nodiscard]] std::int64_t count() const noexcept {
    return count_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] double mean_s() const noexcept { return mean_s_.load(std::memory_order_relaxed); }
  [[nodiscard]] double scatter_s() const noexcept {
    return scatter_s_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] double longest_s() const noexcept {
    return longest_s_.load(std::memory_order_relaxed);
  }

 private:
  std::int64_t last_ns_ = 0, periods_ = 0;
  double mean_ns_ = 0.0, square_ns2_ = 0.0;
  std::atomic<std::int64_t> count_{0};
  std::atomic<double> mean_s_{0.0}, scatter_s_{0.0}, longest_s_{0.0};
};

}  // namespace cavum
