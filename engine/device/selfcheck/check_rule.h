// Is a station's stylus as it was? A check is compared with the station's own earlier ones by
// prediction intervals of Student's t, whose rate of false alarms is known whatever the scatter is:
// of a station that did not change, at most k_false_alarms of the checks are called changed.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/device/selfcheck/arm_figures.h"

namespace cavum {

/// Nothing is claimed before so many checks; no more than the first so many are compared with, so
/// that creeping change is not learnt.
inline constexpr std::size_t k_checks_to_learn = 8, k_checks_compared = 30;
/// Share of a check's false alarms that each comparison may have: mean of the axes, one axis, step,
/// rate. Together k_false_alarms.
inline constexpr double k_mean_alarms = 0.004, k_axis_alarms = 0.0015, k_step_alarms = 0.003,
                        k_rate_alarms = 0.004;
inline constexpr double k_false_alarms =
    2 * (k_mean_alarms + 3 * k_axis_alarms) + k_step_alarms + k_rate_alarms;
/// Smaller changes are not called any: N, shares.
inline constexpr double k_min_friction_n = 0.04, k_min_gain = 0.04, k_min_step = 0.15,
                        k_min_rate = 0.10;

enum class CheckOutcome { learning, unchanged, changed, doubtful };
/// "learning" and so on.
[[nodiscard]] const char* outcome_name(CheckOutcome outcome) noexcept;
/// For people.
[[nodiscard]] Message word_of(CheckOutcome outcome);

struct CheckChange {
  std::string quantity;  ///< friction, gain, mass, "gain or mass", step, rate
  std::string axis;      ///< x, y, z of the stylus, or empty: the mean
  double before = 0.0, now = 0.0;
  double change = 0.0;     ///< friction in N; others as a share, gain -0.1 for a tenth less
  double uncertain = 0.0;  ///< half of the 95 % interval of `change`
};

struct CheckVerdict {
  CheckOutcome outcome = CheckOutcome::learning;
  std::size_t compared = 0;          ///< checks that it was compared with
  std::vector<CheckChange> changes;  ///< largest first, by its own scatter
  double finds_friction_n = 0.0;  ///< change of the mean that is found in 95 %, by this station's
                                  ///< scatter; 0 while it learns
  double finds_gain = 0.0;        ///< the same of the gain, as a share
  Message doubt;                  ///< why nothing can be said, and what to do
};

/// `earlier`: the station's checks of this stylus that count, oldest first.
[[nodiscard]] CheckVerdict judge_check(const ArmFigures& now, std::span<const ArmFigures> earlier);
/// In a sentence or two: what changed, by how much, and what to do.
[[nodiscard]] Message in_words(const CheckVerdict& verdict);

}  // namespace cavum
