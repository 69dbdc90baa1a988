// A generator of our own (SplitMix64), because std::*_distribution differs between libraries. Used
// by the simulated hand and by tests; the servo step itself draws no random number.
#pragma once

#include <cstdint>

namespace cavum {

/// Deterministic random numbers from a 64-bit seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : state_(seed) {}

  std::uint64_t next() noexcept {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1), 53 bits.
  double uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }
  /// Whole number in [0, n), n > 0.
  std::uint64_t below(std::uint64_t n) noexcept { return next() % n; }
  /// Mean 0, variance 1, as the sum of twelve uniforms: no libm, tails end at 6.
  double normal() noexcept {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

 private:
  std::uint64_t state_;
};

}  // namespace cavum
