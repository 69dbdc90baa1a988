// An exam's motion in even steps of time, short enough to draw: where the tip was, how it was held,
// and in each step the largest force, so that no peak is lost between two of them.
#pragma once

#include <cstdint>
#include <vector>

#include "grading/marking/grade.h"

namespace cavum::report {

/// Sample i belongs to i · step_s and what follows until the next.
struct MotionTrack {
  double step_s = 0.02;
  std::vector<std::int16_t> x_um, y_um, z_um;       ///< tip, tooth frame, clamped to ±32 mm
  std::vector<std::int8_t> axis_x, axis_y, axis_z;  ///< from tip to handle, unit vector in 1/127
  std::vector<std::uint16_t> force_cn;  ///< largest size of the rendered force in the step, 0.01 N
  std::vector<std::int16_t> depth_um;   ///< of the tip under the tooth's opening, negative above it
  std::vector<std::uint16_t> rpm10;     ///< 10 rpm
  std::vector<std::uint16_t> tip_50um_s;  ///< speed of the tip, mean over the step, 0.05 mm/s: up
                                          ///< to 3.2 m/s, as a tip through its 64 mm
  [[nodiscard]] std::size_t size() const noexcept { return x_um.size(); }
};

/// Steps of 20 ms, longer for recordings of more than `most` of them.
[[nodiscard]] MotionTrack make_motion_track(const grading::GradeInput& input,
                                            std::size_t most = 45'000);

}  // namespace cavum::report
