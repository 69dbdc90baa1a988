// A haptic arm that nobody holds, for tests of the self-check: three joints askew to the axes of
// its places, each with mass, Coulomb friction with a Stribeck rise, viscous friction and cable
// ripple; weight that is not quite balanced; backlash; encoders; exchanges at the device's own
// rate, late and unevenly. It shares no code with the check.
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "engine/device/stylus.h"

namespace cavum::testing_selfcheck {

struct ArmModel {
  std::array<double, 3> mass_kg{0.1, 0.1, 0.1};  ///< of each joint, at the tip
  std::array<double, 3> coulomb_n{0.2, 0.2, 0.2};
  double stribeck = 0.1;       ///< friction near rest is larger by this share ...
  double stribeck_mm_s = 5.0;  ///< ... below this speed
  double viscous_n_s_per_mm = 2e-4;
  double ripple_n = 0.01, ripple_mm = 4.0;  ///< of cables and poles: amplitude, period
  Vec3 weight_n;                            ///< that nothing balances
  double spring_n_per_mm = 0.0;             ///< of a balance, towards home
  double backlash_mm = 0.0;                 ///< between each joint and its encoder
  double gain = 1.0;                        ///< force given, of what is commanded
  double quantum_mm = 0.02;
  bool joint_encoders = false;  ///< steps along the joints, or else along the axes
  double rate_hz = 1000.0;      ///< of its exchanges
  double jitter = 0.1;          ///< of their periods, as a share
  int delay = 1;                ///< exchanges from command to force
  double skew_rad = 0.3;        ///< of the joints against the axes
  bool one_friction = false;    ///< against the whole speed, instead of each joint's own
};

/// A hand on the stylus.
struct ArmHand {
  double mass_kg = 0.0, stiffness_n_per_mm = 0.0, damping_n_s_per_mm = 0.0, tremor_mm = 0.0,
         tremor_hz = 9.0;
};

class FreeArm final : public Stylus {
 public:
  FreeArm(const ArmModel& model, Vec3 at_mm, std::uint64_t seed);

  [[nodiscard]] DeviceReading read(double elapsed_s) override;
  void send_force(Vec3 force_n) override { commanded_n_ = force_n; }
  void cut_force() noexcept override { commanded_n_ = {}; }
  [[nodiscard]] const StylusFacts& facts() const noexcept override { return facts_; }
  [[nodiscard]] StylusHealth health() const override;

  void set_hand(const ArmHand& hand) { hand_ = hand; }
  /// A wall at this place along x; the arm does not go beyond.
  void set_wall(double x_mm) { wall_mm_ = x_mm; }
  void fall_silent() { silent_ = true; }
  [[nodiscard]] double largest_force_n() const noexcept { return largest_n_; }
  [[nodiscard]] Vec3 commanded_n() const noexcept { return commanded_n_; }

 private:
  void exchange();
  void move(double dt_s);
  [[nodiscard]] Vec3 to_joints(Vec3 v) const;
  [[nodiscard]] Vec3 to_axes(Vec3 v) const;

  ArmModel model_;
  ArmHand hand_;
  StylusFacts facts_;
  std::mt19937_64 random_;
  std::array<Vec3, 3> joints_;  // unit vectors
  Vec3 at_, speed_, home_;      // of the motor, along the joints; home along the axes
  Vec3 play_;                   // where the encoders stand within the backlash, along the joints
  Vec3 told_mm_, commanded_n_;
  std::array<Vec3, 8> queue_{};
  double time_s_ = 0.0, next_exchange_s_ = 0.0, wall_mm_ = 1e9, largest_n_ = 0.0;
  std::int64_t readings_ = 0;
  bool silent_ = false;
};

}  // namespace cavum::testing_selfcheck
