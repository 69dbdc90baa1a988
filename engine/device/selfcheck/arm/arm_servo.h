// The loop in which a stylus is checked: a tick each millisecond, forces of at most a newton, and
// an end of all force as soon as something is felt that is no free arm.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/base/message.h"
#include "engine/device/stylus.h"

namespace cavum {

/// Why a check was given up: what was felt, and what to do.
class ArmStopped : public std::runtime_error {
 public:
  explicit ArmStopped(Message why) : std::runtime_error(english_text(why)), why_(std::move(why)) {}
  [[nodiscard]] const Message& why() const noexcept { return why_; }

 private:
  Message why_;
};

struct ArmSample {
  double t_s = 0.0;
  Vec3 at_mm;    ///< told at this tick
  Vec3 force_n;  ///< commanded from this tick on
  bool fresh = false;
};

/// Waits for the next tick and says when it is, ns on a clock that never goes back.
using ArmClock = std::function<std::int64_t()>;
/// Each millisecond of the computer's clock.
[[nodiscard]] ArmClock real_arm_clock();

class ArmServo {
 public:
  static constexpr double k_tick_of_check_s = 1e-3;

  /// `home_mm`: where it is checked, stylus frame. `most_n`: no force is larger. `stop`: asked each
  /// tick; may be empty.
  ArmServo(Stylus& stylus, Vec3 home_mm, double most_n, ArmClock clock, std::function<bool()> stop);
  ~ArmServo() { stylus_.cut_force(); }
  ArmServo(const ArmServo&) = delete;
  ArmServo& operator=(const ArmServo&) = delete;

  /// Waits for the next tick and reads. Throws ArmStopped when it was stopped or leaves its place,
  /// Error when the stylus is silent for half a second.
  void look();
  /// Commands a force until the next, at most `most_n`, and keeps the sample.
  void push(Vec3 force_n);
  /// Spring and damper towards a place that moves at `speed_mm_s`, and what the arm leans on it.
  [[nodiscard]] Vec3 hold(Vec3 wanted_mm, Vec3 speed_mm_s = {}) const;
  /// Learns what the arm leans on the hold, so that it stands at `wanted_mm`.
  void learn_lean(Vec3 wanted_mm);
  void set_lean(std::size_t axis, double n);
  /// Holds it there for so long.
  void rest(Vec3 wanted_mm, double seconds, bool learn);

  [[nodiscard]] double now_s() const noexcept { return now_s_; }
  [[nodiscard]] double dt_s() const noexcept { return dt_s_; }
  [[nodiscard]] Vec3 at_mm() const noexcept { return at_mm_; }
  [[nodiscard]] Vec3 speed_mm_s() const noexcept { return speed_mm_s_; }
  [[nodiscard]] Vec3 lean_n() const noexcept { return lean_n_; }
  [[nodiscard]] Vec3 home_mm() const noexcept { return home_mm_; }
  [[nodiscard]] double most_n() const noexcept { return most_n_; }
  /// Farther from home than this it is stopped.
  void set_leash(double mm) noexcept { leash_mm_ = mm; }

  [[nodiscard]] const std::vector<ArmSample>& samples() const noexcept { return samples_; }
  [[nodiscard]] const std::vector<double>& periods_s() const noexcept { return periods_s_; }
  [[nodiscard]] std::int64_t stale() const noexcept { return stale_; }

 private:
  Stylus& stylus_;
  const Vec3 home_mm_;
  const double most_n_;
  ArmClock clock_;
  std::function<bool()> stop_;
  std::int64_t begin_ns_ = 0, last_ns_ = 0;
  double now_s_ = 0.0, dt_s_ = k_tick_of_check_s, leash_mm_ = 1e9, moved_s_ = 0.0;
  Vec3 at_mm_, speed_mm_s_, lean_n_;
  bool known_ = false, fresh_ = false;
  int silent_ = 0;
  std::int64_t stale_ = 0;
  std::vector<ArmSample> samples_;
  std::vector<double> periods_s_;
};

[[nodiscard]] inline double on_axis(Vec3 v, std::size_t axis) noexcept {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
[[nodiscard]] inline Vec3 along_axis(std::size_t axis, double size) noexcept {
  return {axis == 0 ? size : 0.0, axis == 1 ? size : 0.0, axis == 2 ? size : 0.0};
}

}  // namespace cavum
