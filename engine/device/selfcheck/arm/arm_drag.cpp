#include "engine/device/selfcheck/arm/arm_drag.h"

#include <array>
#include <cmath>
#include <vector>

#include "engine/base/statistics.h"

namespace cavum {
namespace {

constexpr double k_drag_mm = 6.5,
                 k_drag_mm_s = 12.0;  // half the way of the spring's end, and its speed
constexpr double k_counted_mm = 2.5;  // of the arm's own way, on both sides of home
constexpr int k_drag_passes = 6;      // three forth, three back
constexpr double k_blocked_s = 0.3;

constexpr std::array<const char*, 3> k_axis_names{"x", "y", "z"};

/// Work over way within the counted places; 0 when too little of them was passed.
double mean_force_n(const std::vector<ArmSample>& samples, std::size_t from, std::size_t to,
                    std::size_t axis, double home) {
  double work = 0.0, way = 0.0;
  for (std::size_t i = from; i + 1 < to; ++i) {
    const double a = on_axis(samples[i].at_mm, axis) - home,
                 b = on_axis(samples[i + 1].at_mm, axis) - home;
    if (std::abs(0.5 * (a + b)) > k_counted_mm) continue;
    work += on_axis(samples[i].force_n, axis) * (b - a);
    way += b - a;
  }
  return std::abs(way) > 1.6 * k_counted_mm ? work / way : NAN;
}

}  // namespace

void drag_axis(ArmServo& servo, std::size_t axis, ArmFigures& figures) {
  const Vec3 home = servo.home_mm();
  double end_mm = 0.0, blocked_s = 0.0;
  std::vector<double> forth, back;
  const auto move_end = [&](double target_mm) {
    const double way = target_mm > end_mm ? 1.0 : -1.0;
    while ((target_mm - end_mm) * way > 0.0) {
      servo.look();
      end_mm += way * k_drag_mm_s * std::min(servo.dt_s(), 0.02);
      const Vec3 force =
          servo.hold(home + along_axis(axis, end_mm), along_axis(axis, way * k_drag_mm_s));
      servo.push(force);
      const bool strained = length(force) > servo.most_n() &&
                            on_axis(servo.speed_mm_s(), axis) * way < 0.2 * k_drag_mm_s;
      blocked_s = strained ? blocked_s + servo.dt_s() : 0.0;
      if (blocked_s > k_blocked_s)
        throw ArmStopped(msg(
            "it does not follow {} N along {}: take the hand off it, and what stands in its way, and begin again; when nothing does, its joints "
            "are stuck",
            servo.most_n(), k_axis_names[axis]));
    }
  };
  move_end(k_drag_mm);
  for (int pass = 0; pass < k_drag_passes; ++pass) {
    const std::size_t from = servo.samples().size();
    move_end(pass % 2 == 0 ? -k_drag_mm : k_drag_mm);
    (pass % 2 == 0 ? back : forth)
        .push_back(
            mean_force_n(servo.samples(), from, servo.samples().size(), axis, on_axis(home, axis)));
  }
  std::vector<double> half_width, middle;
  for (std::size_t i = 0; i < forth.size(); ++i) {
    half_width.push_back(0.5 * (forth[i] - back[i]));
    middle.push_back(0.5 * (forth[i] + back[i]));
    if (!std::isfinite(half_width.back()))
      throw ArmStopped(msg(
          "it did not go the way along {}: take the hand off it, and what stands in its way, and begin again",
          k_axis_names[axis]));
  }
  const MeanSd friction = mean_sd(half_width);
  ArmAxis& a = figures.axes[axis];
  a.friction_n = friction.mean;
  a.friction_error_n = friction.sd / std::sqrt(static_cast<double>(half_width.size()));
  a.weight_n = mean(middle);
  move_end(0.0);
  servo.set_lean(axis, a.weight_n);
}

}  // namespace cavum
