#include "grading/measures/motion.h"

#include <algorithm>
#include <cmath>

namespace cavum::grading {
namespace {
// positions are recorded to a nanometre and forces to a micronewton in each axis: half of that,
// times sqrt(3)
constexpr double k_rounded_mm = 0.87e-6, k_rounded_n = 0.87e-6;
}  // namespace

double force_n(const TickRecord& r) noexcept {
  return length({r.rendered_un[0] * 1e-6, r.rendered_un[1] * 1e-6, r.rendered_un[2] * 1e-6});
}

std::vector<TickSpan> idle_spans(const GradeInput& input, std::int64_t ticks,
                                 const std::vector<PauseMeasure>& pauses) {
  const auto n = static_cast<std::size_t>(ticks);
  std::vector<std::uint8_t> paused(n, 0);
  for (const auto& p : pauses)
    for (std::int64_t i = p.begin; i < std::min(p.end, ticks); ++i)
      paused[static_cast<std::size_t>(i)] = 1;
  std::vector<TickSpan> spans;
  const auto window = static_cast<std::size_t>(k_idle_window_ticks);
  for (std::size_t i = 0; i + window <= n; i += window) {
    bool quiet = true;
    for (std::size_t j = i; j < i + window && quiet; ++j)
      quiet = paused[j] == 0 && input.records[j].removed == 0 &&
              !(input.records[j].penetration_nm > 0 && input.records[j].rpm >= k_turning_rpm) &&
              length(input.inputs[j].tip_mm() - input.inputs[i].tip_mm()) <= k_idle_mm;
    if (!quiet) continue;
    const auto begin = static_cast<std::int64_t>(i), end = begin + k_idle_window_ticks;
    if (!spans.empty() && spans.back().end == begin)
      spans.back().end = end;
    else
      spans.push_back({begin, end});
  }
  return spans;
}

MotionMeasures measure_motion(const GradeInput& input, std::int64_t ticks,
                              const std::vector<PauseMeasure>& pauses) {
  MotionMeasures m;
  const auto n = static_cast<std::size_t>(ticks);
  std::vector<std::uint8_t> paused(n, 0);
  std::int64_t standing = 0;  // ticks in which the exam's clock stood still
  for (const auto& p : pauses)
    for (std::int64_t i = p.begin; i < std::min(p.end, ticks); ++i, ++standing)
      paused[static_cast<std::size_t>(i)] = 1;
  m.time_s = static_cast<double>(ticks - standing) * k_tick_s;
  m.late_ticks = static_cast<std::int64_t>(input.inputs.size()) - ticks;
  const auto tip = [&](std::size_t i) { return input.inputs[i].tip_mm(); };
  double sum = 0;
  std::int64_t turning = 0, cutting = 0, over = 0, turning_ends = 0, over_ends = 0;
  bool turned = false, pressed = false;
  for (std::size_t i = 0; i < n; ++i) {
    if (paused[i] != 0) continue;
    const TickRecord& r = input.records[i];
    const double f = force_n(r);
    const bool turns = r.rpm >= k_turning_rpm;
    turning += turns ? 1 : 0;
    turning_ends += turns != turned ? 1 : 0;
    turned = turns;
    if (turns && r.penetration_nm > 0) {
      sum += f;
      ++cutting;
    }
    if (f > m.force_peak_n) {
      m.force_peak_n = f;
      m.force_peak = {static_cast<std::int64_t>(i), tip(i)};
    }
    const bool presses = input.scenario.force_limit_n > 0 && f > input.scenario.force_limit_n;
    over_ends += presses != pressed ? 1 : 0;
    pressed = presses;
    if (presses) {
      if (over++ == 0) m.first_over_limit = {static_cast<std::int64_t>(i), tip(i)};
    }
  }
  for (std::size_t i = static_cast<std::size_t>(k_path_step_ticks); i < n;
       i += static_cast<std::size_t>(k_path_step_ticks))
    if (paused[i] == 0 && paused[i - static_cast<std::size_t>(k_path_step_ticks)] == 0) {
      m.path_bound_mm += 2 * k_rounded_mm;
      m.path_mm += length(tip(i) - tip(i - static_cast<std::size_t>(k_path_step_ticks)));
    }
  std::int64_t idle = 0;
  const auto spans = idle_spans(input, ticks, pauses);
  for (const auto& span : spans) idle += span.end - span.begin;
  m.time_bound_s = k_tick_s;
  m.handpiece_bound_s = static_cast<double>(turning_ends) * k_tick_s;
  m.over_limit_bound_s = static_cast<double>(over_ends) * k_tick_s;
  m.idle_bound_s =
      static_cast<double>(2 * static_cast<std::int64_t>(spans.size()) * k_idle_window_ticks) *
      k_tick_s;
  m.force_bound_n = k_rounded_n;
  m.handpiece_time_s = static_cast<double>(turning) * k_tick_s;
  m.idle_s = static_cast<double>(idle) * k_tick_s;
  m.force_mean_n = cutting > 0 ? sum / static_cast<double>(cutting) : 0.0;
  m.force_over_limit_s = static_cast<double>(over) * k_tick_s;
  return m;
}

}  // namespace cavum::grading
