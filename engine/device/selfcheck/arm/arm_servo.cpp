#include "engine/device/selfcheck/arm/arm_servo.h"

#include <algorithm>
#include <cmath>

#include "engine/device/device_error.h"
#include "engine/physics/servo/scheduling.h"

namespace cavum {
namespace {

constexpr double k_hold_n_per_mm = 0.2, k_hold_n_s_per_mm = 0.0025, k_lean_n_per_mm_s = 0.5;
constexpr double k_speed_filter_s = 0.008;

}  // namespace

ArmClock real_arm_clock() {
  constexpr std::int64_t k_tick_ns = 1'000'000;
  return [due = monotonic_ns()]() mutable {
    due = std::max(due + k_tick_ns, monotonic_ns());  // a tick that was missed is not made up for
    sleep_until(due);
    return monotonic_ns();
  };
}

ArmServo::ArmServo(Stylus& stylus, Vec3 home_mm, double most_n, ArmClock clock,
                   std::function<bool()> stop)
    : stylus_(stylus),
      home_mm_(home_mm),
      most_n_(most_n),
      clock_(std::move(clock)),
      stop_(std::move(stop)) {
  constexpr std::size_t k_minute = 60'000;
  samples_.reserve(k_minute);
  periods_s_.reserve(k_minute);
}

void ArmServo::look() {
  constexpr int k_max_silent = 500;
  if (stop_ && stop_()) throw ArmStopped(msg("it was stopped; begin it again"));
  const std::int64_t now = clock_();
  if (last_ns_ != 0) {
    dt_s_ = static_cast<double>(now - last_ns_) * 1e-9;
    periods_s_.push_back(dt_s_);
  } else {
    begin_ns_ = now;
  }
  last_ns_ = now;
  now_s_ = static_cast<double>(now - begin_ns_) * 1e-9;
  const DeviceReading r = stylus_.read(dt_s_);
  fresh_ = (r.flags & k_stylus_fresh) != 0 && is_finite(r.pose.tip_mm);
  moved_s_ += dt_s_;
  if (!fresh_) {
    ++stale_;
    if (++silent_ > k_max_silent) {
      stylus_.cut_force();
      throw stylus_error(stylus_.facts().id, DeviceError::silent,
                         msg("fell silent while it was checked"),
                         msg("see `cavum devices`, and begin again"));
    }
    return;
  }
  silent_ = 0;
  if (known_ && moved_s_ > 0.0) {
    const double share = std::min(1.0, moved_s_ / k_speed_filter_s);
    speed_mm_s_ += ((r.pose.tip_mm - at_mm_) / moved_s_ - speed_mm_s_) * share;
  }
  moved_s_ = 0.0;
  known_ = true;
  at_mm_ = r.pose.tip_mm;
  if (length(at_mm_ - home_mm_) > leash_mm_) {
    stylus_.cut_force();
    throw ArmStopped(
        msg("it was carried off from where it is checked; take the hand off it, and begin again"));
  }
}

void ArmServo::push(Vec3 force_n) {
  const double size = length(force_n);
  const Vec3 given = size > most_n_ ? force_n * (most_n_ / size) : force_n;
  stylus_.send_force(given);
  samples_.push_back({now_s_, at_mm_, given, fresh_});
}

Vec3 ArmServo::hold(Vec3 wanted_mm, Vec3 speed_mm_s) const {
  return lean_n_ + (wanted_mm - at_mm_) * k_hold_n_per_mm +
         (speed_mm_s - speed_mm_s_) * k_hold_n_s_per_mm;
}

void ArmServo::learn_lean(Vec3 wanted_mm) {
  lean_n_ += (wanted_mm - at_mm_) * (k_lean_n_per_mm_s * std::min(dt_s_, 0.01));
  if (const double size = length(lean_n_); size > most_n_) lean_n_ = lean_n_ * (most_n_ / size);
}

void ArmServo::set_lean(std::size_t axis, double n) {
  lean_n_ += along_axis(axis, n - on_axis(lean_n_, axis));
}

void ArmServo::rest(Vec3 wanted_mm, double seconds, bool learn) {
  for (const double until = now_s_ + seconds; now_s_ < until;) {
    look();
    if (learn) learn_lean(wanted_mm);
    push(hold(wanted_mm));
  }
}

}  // namespace cavum
