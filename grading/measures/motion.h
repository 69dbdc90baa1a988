// Time, way and force of an exam, from the recorded ticks alone.
#pragma once

#include "grading/measures/grade_input.h"

namespace cavum::grading {

/// The handpiece counts as turning from this speed on, 1/min.
inline constexpr std::int32_t k_turning_rpm = 1000;
/// The way of the tip is summed over steps of this many ticks, so that the device's position
/// quantum and tremor at rest add little.
inline constexpr std::int64_t k_path_step_ticks = 10;
/// Idle: a tenth of a second in which the tip stays within this and nothing is cut: the handpiece
/// does not turn in contact, nothing is removed.
inline constexpr std::int64_t k_idle_window_ticks = 100;
inline constexpr double k_idle_mm = 0.05;

/// Size of the rendered force of a tick, N.
[[nodiscard]] double force_n(const TickRecord& record) noexcept;

/// Ticks begin to end - 1.
struct TickSpan {
  std::int64_t begin = 0, end = 0;
};
/// Idle tenths of a second, neighbours joined; `ticks`: how many count.
[[nodiscard]] std::vector<TickSpan> idle_spans(const GradeInput& input, std::int64_t ticks,
                                               const std::vector<PauseMeasure>& pauses);

/// `ticks`: how many count.
[[nodiscard]] MotionMeasures measure_motion(const GradeInput& input, std::int64_t ticks,
                                            const std::vector<PauseMeasure>& pauses = {});

}  // namespace cavum::grading
