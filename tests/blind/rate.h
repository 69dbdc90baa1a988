// A promised rate held against what was counted, with exact binomial tails: a run fails only where
// the promise (or, while a promise is not kept yet, the rate measured so far) could hardly have
// given so few.
#pragma once

#include <string>

namespace cavum::blind {

/// P(X <= successes) for `trials` trials of probability `p`.
[[nodiscard]] double binomial_at_most(int successes, int trials, double p);

/// Smallest count that is no evidence at 0.001 against rate `p`; 0 if any count is possible.
[[nodiscard]] int least_expected(int trials, double p);

struct Rate {
  std::string name;
  double promise = 0.0;  ///< what explain has to show
  int successes = 0, trials = 0;

  void count(bool success) { successes += success, ++trials; }
  [[nodiscard]] double value() const {
    return trials > 0 ? static_cast<double>(successes) / trials : 0.0;
  }
};

}  // namespace cavum::blind
