// The moments of an exam that `grade --why` speaks of: removed leaves and ticks of which something holds, gathered into stretches of
// time, and the largest of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "grading/why.h"

namespace cavum {

/// Removed leaves before tick `end` that count, gathered while less than k_moment_gap_ticks lie between them: amount = their volume (whole
/// leaves, mm3), place = the one furthest beyond the target.
[[nodiscard]] std::vector<WhyItem> removal_moments(const GradeInput& input, std::int64_t end, const std::function<bool(const RemovedAt&)>& counts);

/// What the amount of a stretch of ticks is: how long it held (s), or the largest force in it (N).
enum class Stretch { duration, peak_force };
/// Ticks before `end` that count, gathered while at most `gap` others lie between them; place = the tip where the force was largest.
[[nodiscard]] std::vector<WhyItem> tick_stretches(const GradeInput& input, std::int64_t end, const std::function<bool(std::int64_t)>& counts,
                                                  std::int64_t gap, const std::string& what, Stretch amount);

/// Keeps the k_most_moments items of the largest amount in their order, of equal ones the earlier; returns how many went. Every item has an amount.
std::size_t keep_largest(std::vector<WhyItem>& items);

}  // namespace cavum
