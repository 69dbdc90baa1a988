// The moments of an exam that `grade --why` speaks of: removed leaves and ticks of which something
// holds, gathered into stretches of time, and the largest of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "grading/feedback/why.h"
#include "grading/measures/volumes.h"

namespace cavum::grading {

/// What was removed, gathered while at most k_moment_gap_ticks lie between: amount = its volume,
/// mm3, and its bound; place = the leaf furthest beyond the target; told are the zones that it lies
/// in, each with its volume when they are several, and the wall that most of it lies at.
[[nodiscard]] std::vector<WhyItem> removal_moments(const scenarios::ZoneMap& zones,
                                                   std::vector<RemovedShare> shares);
/// The same of removed leaves before tick `end` that count, taken whole.
[[nodiscard]] std::vector<WhyItem> removal_moments(
    const GradeInput& input, std::int64_t end, const std::function<bool(const RemovedAt&)>& counts);

/// What the amount of a stretch of ticks is: how long it held (s), or the largest force in it (N).
enum class Stretch { duration, peak_force };
/// Ticks before `end` that count, gathered while at most `gap` others lie between them; place = the
/// tip where the force was largest.
[[nodiscard]] std::vector<WhyItem> tick_stretches(const GradeInput& input, std::int64_t end,
                                                  const std::function<bool(std::int64_t)>& counts,
                                                  std::int64_t gap, const Fact& what,
                                                  Stretch amount);

/// Idle time in spans, which add up to it, s.
[[nodiscard]] std::vector<WhyItem> idle_moments(const GradeInput& input, std::int64_t end,
                                                const std::vector<PauseMeasure>& pauses);

/// The last leaf removed before tick `end` within a millimetre of a place; and whether there was
/// one, in words.
[[nodiscard]] Trace last_cut_near(const GradeInput& input, std::int64_t end, Vec3 place_mm);
[[nodiscard]] Fact last_cut(const Trace& last);
/// Each piece of roof that was left, mm3, and when something was last cut near it.
[[nodiscard]] std::vector<WhyItem> overhang_moments(const GradeInput& input, std::int64_t end,
                                                    const AccessMeasures& access);

/// Keeps the k_max_moments items of the largest amount in their order, of equal ones the earlier;
/// returns those that went. Every item has an amount.
std::vector<WhyItem> keep_largest(std::vector<WhyItem>& items);

}  // namespace cavum::grading
