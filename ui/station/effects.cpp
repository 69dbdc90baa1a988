#include "ui/station/effects.h"

#include <algorithm>

namespace cavum::station {

void EffectGovernor::took(double ms) {
  constexpr double k_to_spare =
      0.45;  // of the budget: the next richer level takes less than twice as long
  constexpr std::size_t k_max_patience = 2000;
  last_ms_[measured_ % k_looked_at] = ms;
  ++measured_;
  if (measured_ < k_looked_at) return;
  auto sorted = last_ms_;
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted[k_looked_at / 2];
  in_time_ = median < k_to_spare * budget_ms_ ? in_time_ + 1 : 0;
  if (median > budget_ms_ && level_ + 1 < k_effects.size()) {
    ++level_;
    patience_ =
        std::min(2 * patience_, k_max_patience);  // what did not hold is not tried again soon
    measured_ = in_time_ = 0;
  } else if (in_time_ > patience_ && level_ > 0) {
    --level_;
    measured_ = in_time_ = 0;
  }
}

}  // namespace cavum::station
