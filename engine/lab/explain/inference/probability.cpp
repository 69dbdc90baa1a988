#include "engine/lab/explain/inference/probability.h"

#include <algorithm>
#include <cmath>

namespace cavum::explain {
namespace {

constexpr double k_temper = 2.5;  // s: laws fit a little worse than they are
// log odds
constexpr double k_base = 4.5, k_something_left = -1.0, k_more = -1.5;
constexpr double k_share =
    2.3;  // for e times the share of what lies between the simulation and the noise
constexpr double k_gain = 2.4;  // for e times the gain on sessions left out, below k_enough_percent
constexpr double k_enough_percent = 8.0;
// where the logarithms end. Real recordings hold much that no law has: the share is then small
// beside a true cause, too (data/measured/real/oring_*)
constexpr double k_min_share_percent = 45.0, k_min_percent = 0.3;
constexpr double k_most = 0.98;  // no calibration so far says more

double set_probability(const Explanation& e, const Cause& c) {
  const double share = std::clamp(e.gain.share_percent, k_min_share_percent, 100.0) / 100.0;
  const double gain =
      std::clamp(c.gain_percent.value, k_min_percent, k_enough_percent) / k_enough_percent;
  double odds = k_base + k_more * static_cast<double>(e.causes.size() - 1) +
                k_share * std::log(share) + k_gain * std::log(gain);
  if (e.unexplained) odds += k_something_left;
  return std::min(k_most, 1.0 / (1.0 + std::exp(-odds)));
}

/// Of the set's, the cause's own share.
double own_share(const Cause& c) {
  double all = 1.0;
  for (const auto& name : c.aliases) {
    double behind = 0.0;  // what the data cannot tell for another reason than fit shares alike
    for (const auto& r : c.rivals)
      if (r.mechanism == name) behind = std::max(0.0, r.behind_chi2);
    all += std::exp(-0.5 * behind / k_temper);
  }
  return 1.0 / all;
}

}  // namespace

void set_probabilities(Explanation& e) {
  for (auto& c : e.causes) {
    c.set_probability = set_probability(e, c);
    c.probability = c.set_probability * own_share(c);
  }
}

Message probability_words(double p) {
  if (p >= 0.95) return msg("extremely likely");
  if (p >= 0.9) return msg("very likely");
  if (p >= 0.66) return msg("likely");
  if (p >= 0.33) return msg("about as likely as not");
  return msg("unlikely");
}

}  // namespace cavum::explain
