#include "ui/report/figures/motion_track.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grading/measures/motion.h"

namespace cavum::report {
namespace {

constexpr std::size_t k_step_ticks = 20;

template <class T>
T whole(double v) {
  constexpr double low = std::numeric_limits<T>::min(), high = std::numeric_limits<T>::max();
  return static_cast<T>(std::lround(std::clamp(v, low, high)));
}

}  // namespace

MotionTrack make_motion_track(const grading::GradeInput& input, std::size_t most) {
  MotionTrack t;
  const std::size_t ticks = std::min(input.inputs.size(), input.records.size());
  std::size_t step = k_step_ticks;
  while ((ticks + step - 1) / step > most) step += k_step_ticks;
  t.step_s = static_cast<double>(step) * k_tick_s;
  for (std::size_t first = 0; first < ticks; first += step) {
    const std::size_t end = std::min(ticks, first + step);
    const Pose pose = input.inputs[first].pose();
    const Vec3 tip = pose.tip_mm, axis = rotation(pose.rotation) * Vec3{0, 0, 1};
    double force = 0;
    for (std::size_t i = first; i < end; ++i)
      force = std::max(force, grading::force_n(input.records[i]));
    t.x_um.push_back(whole<std::int16_t>(tip.x * 1e3));
    t.y_um.push_back(whole<std::int16_t>(tip.y * 1e3));
    t.z_um.push_back(whole<std::int16_t>(tip.z * 1e3));
    t.axis_x.push_back(whole<std::int8_t>(axis.x * 127));
    t.axis_y.push_back(whole<std::int8_t>(axis.y * 127));
    t.axis_z.push_back(whole<std::int8_t>(axis.z * 127));
    t.force_cn.push_back(whole<std::uint16_t>(force * 100));
    t.depth_um.push_back(whole<std::int16_t>(input.zones.below_opening_mm(tip) * 1e3));
    t.rpm10.push_back(whole<std::uint16_t>(input.records[first].rpm * 0.1));
    const std::size_t next = std::min(end, ticks - 1);
    const double moved_mm = length(input.inputs[next].tip_mm() - tip),
                 time_s = static_cast<double>(next - first) * k_tick_s;
    t.tip_50um_s.push_back(whole<std::uint16_t>(time_s > 0 ? moved_mm / time_s * 20 : 0));
  }
  return t;
}

}  // namespace cavum::report
