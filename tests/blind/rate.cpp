#include "tests/blind/rate.h"

#include <cmath>

namespace cavum::blind {

double binomial_at_most(int successes, int trials, double p) {
  if (successes >= trials) return 1.0;
  if (p >= 1.0) return 0.0;
  if (p <= 0.0) return 1.0;
  double sum = 0.0;
  for (int i = 0; i <= successes; ++i)
    sum +=
        std::exp(std::lgamma(trials + 1.0) - std::lgamma(i + 1.0) - std::lgamma(trials - i + 1.0) +
                 i * std::log(p) + (trials - i) * std::log1p(-p));
  return sum;
}

int least_expected(int trials, double p) {
  int least = 0;
  while (least < trials && binomial_at_most(least, trials, p) < 0.001) ++least;
  return least;
}

}  // namespace cavum::blind
