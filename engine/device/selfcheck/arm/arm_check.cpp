#include "engine/device/selfcheck/arm/arm_check.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/order.h"
#include "engine/base/statistics.h"
#include "engine/device/selfcheck/arm/arm_drag.h"
#include "engine/device/selfcheck/arm/arm_swing.h"

namespace cavum {
namespace {

constexpr std::array<const char*, 3> k_axes_of_check{"x", "y", "z"};
constexpr double k_leash_mm = 30.0;

/// From where it is drawn home by itself.
double near_mm(const Stylus& stylus) {
  constexpr double k_share_of_reach = 0.9;
  return k_share_of_reach * stylus.facts().reach_mm;
}

/// Waits, without force, until the person has brought the arm near home.
void wait_until_near(ArmServo& servo, const ArmCheckOptions& o, double near) {
  servo.look();
  servo.push({});
  const auto off_mm = [&] { return length(servo.at_mm() - o.home_mm); };
  if (off_mm() <= near) return;
  if (o.tell) o.tell({msg("Bring the stylus to the middle of its reach."), 0.0});
  for (const double until = servo.now_s() + o.patience_s; off_mm() > 0.75 * near;) {
    servo.look();
    servo.push({});
    if (servo.now_s() > until)
      throw ArmStopped(msg(
          "it stands {} mm from the middle of its reach; bring it there, let go of it, and begin again",
          std::lround(off_mm())));
  }
}

/// Draws it home along a straight line, and lets it stand there on its own.
void take_home(ArmServo& servo, const ArmCheckOptions& o, double near) {
  constexpr double k_speed_mm_s = 30.0, k_settle_s = 3.0, k_arrived_mm = 2.0;
  const Vec3 from = servo.at_mm(), way = o.home_mm - from;
  const double takes_s = length(way) / k_speed_mm_s, begin = servo.now_s();
  servo.set_leash(near + k_leash_mm);
  for (double share = 0.0; share < 1.0;) {
    servo.look();
    share = takes_s > 0.0 ? std::min(1.0, (servo.now_s() - begin) / takes_s) : 1.0;
    servo.learn_lean(from + way * share);
    servo.push(servo.hold(from + way * share));
  }
  servo.rest(o.home_mm, k_settle_s, true);
  if (length(servo.at_mm() - o.home_mm) > k_arrived_mm)
    throw ArmStopped(msg(
        "{} N do not hold it in the middle of its reach; take the hand off it, balance it, and begin again",
        o.most_n));
  servo.set_leash(k_leash_mm);
}

/// How far it moves, held, in a second, mm.
double restlessness_mm(ArmServo& servo) {
  constexpr double k_watch_s = 1.0;
  const std::size_t from = servo.samples().size();
  servo.rest(servo.home_mm(), k_watch_s, false);
  double widest = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = 1e9, high = -1e9;
    for (std::size_t i = from; i < servo.samples().size(); ++i) {
      low = std::min(low, on_axis(servo.samples()[i].at_mm, axis));
      high = std::max(high, on_axis(servo.samples()[i].at_mm, axis));
    }
    widest = std::max(widest, high - low);
  }
  return widest;
}

/// A free arm stands still by its own friction, once it has slipped off what it hung on; a hand
/// goes on trembling.
void require_still(ArmServo& servo, double quantum_mm) {
  constexpr int k_watches = 3;
  constexpr double k_still_mm = 0.15, k_still_steps = 5.0;
  double moved_mm = 0.0;
  for (int i = 0; i < k_watches; ++i)
    if (moved_mm = restlessness_mm(servo);
        moved_mm <= std::max(k_still_mm, k_still_steps * quantum_mm))
      return;
  throw ArmStopped(msg(
      "it moves by {} while it should stand still; take the hand off it, keep the table quiet, and begin again",
      as_mm(moved_mm, 2)));
}

/// What the passes themselves say against the figures.
Message doubt_of(const ArmFigures& f) {
  constexpr double k_max_friction_error_n = 0.03, k_max_mass_error = 0.05;
  for (std::size_t i = 0; i < 3; ++i) {
    if (f.axes[i].friction_error_n > k_max_friction_error_n)
      return msg(
          "friction along {} was not the same twice (to {}); take the hand off it, and begin again",
          k_axes_of_check[i], as_n(f.axes[i].friction_error_n, 3));
    if (f.axes[i].mass_error > k_max_mass_error)
      return msg("it did not swing evenly along {} (to {}); take the hand off it, and begin again",
                 k_axes_of_check[i], as_percent(100.0 * f.axes[i].mass_error));
  }
  return {};
}

void take_masses(const std::vector<SwingFit>& fits, ArmFigures& f) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!fits[axis].solved)
      throw ArmStopped(
          msg("its swing along {} could not be read; take the hand off it, and begin again",
              k_axes_of_check[axis]));
    f.axes[axis].mass_kg = fits[axis].mass_kg;
    f.axes[axis].mass_error = fits[axis].mass_error;
  }
}

double step_of(const std::vector<ArmSample>& samples) {
  constexpr double k_no_path_mm = 1e-6, k_share = 0.05;
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i)
    if (const double way = length(samples[i].at_mm - samples[i - 1].at_mm);
        way > k_no_path_mm && samples[i].fresh && samples[i - 1].fresh)
      steps.push_back(way);
  return steps.empty() ? 0.0 : quantile(steps, k_share);
}

void count_ticks(const ArmServo& servo, ArmFigures& f) {
  const std::vector<double>& periods = servo.periods_s();
  if (periods.empty()) return;
  f.tick_mean_ms = 1e3 * mean(periods);
  f.tick_p99_ms = 1e3 * quantile(periods, 0.99);
  f.tick_worst_ms = 1e3 * *std::max_element(periods.begin(), periods.end());
  const auto missed = std::count_if(periods.begin(), periods.end(),
                                    [](double p) { return p > 1.5 * ArmServo::k_tick_of_check_s; });
  f.ticks_missed = static_cast<double>(missed) / static_cast<double>(periods.size());
  f.stale = static_cast<double>(servo.stale()) / static_cast<double>(periods.size());
}

}  // namespace

ArmFigures check_arm(Stylus& stylus, const ArmCheckOptions& o) {
  const StylusHealth before = stylus.health();
  if (before.problem) throw Error(*before.problem);
  ArmFigures f;
  const auto tell = [&](const Message& words, double share) {
    if (o.tell) o.tell({words, share});
  };
  ArmServo servo(stylus, o.home_mm, std::min(o.most_n, stylus.facts().continuous_n),
                 o.clock ? o.clock : real_arm_clock(), o.stop);
  double began_s = 0.0;
  std::array<std::vector<SwingSample>, 3> swings;
  try {
    wait_until_near(servo, o, near_mm(stylus));
    began_s = servo.now_s();
    tell(msg("Let go of the stylus. It is pushed gently, by 1 N at most."), 0.02);
    take_home(servo, o, near_mm(stylus));
    require_still(servo, stylus.facts().position_quantum_mm);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      tell(msg("Friction: it goes slowly forth and back. Do not touch it."),
           0.1 + 0.15 * static_cast<double>(axis));
      drag_axis(servo, axis, f);
    }
    f.doubt = doubt_of(f);
    f.dragged = f.doubt.empty();
    for (std::size_t axis = 0; axis < 3 && f.doubt.empty(); ++axis) {
      tell(msg("Strength: it swings. Do not touch it."), 0.55 + 0.15 * static_cast<double>(axis));
      f.doubt = too_heavy_to_swing(servo, axis, f);
      if (f.doubt.empty()) swings[axis] = swing_axis(servo, axis, f);
    }
    stylus.cut_force();
    if (f.doubt.empty()) {
      tell(msg("Working it out."), 0.99);
      take_masses(fit_swings(swings), f);
    }
    if (f.doubt.empty()) f.doubt = doubt_of(f);
  } catch (const ArmStopped& stopped) {
    f.dragged = false;  // whatever stopped it may have been there before
    f.doubt = stopped.why();
  }
  stylus.cut_force();
  f.seconds = servo.now_s() - began_s;
  f.quantum_mm = step_of(servo.samples());
  count_ticks(servo, f);
  const StylusHealth after = stylus.health();
  if (servo.now_s() > 0.0)
    f.rate_hz = static_cast<double>(after.readings - before.readings) / servo.now_s();
  f.jitter_ms = 1e3 * after.jitter_s;
  tell(msg("Done."), 1.0);
  return f;
}

}  // namespace cavum
