// Families of arms that seeds draw, and how one of them differs from check to check: temperature,
// warming up, wear of the day.
#pragma once

#include <string>
#include <vector>

#include "engine/device/selfcheck/arm_figures.h"
#include "tests/engine/device/selfcheck/free_arm.h"

namespace cavum::testing_selfcheck {

/// light, delta, heavy, worn.
[[nodiscard]] const std::vector<std::string>& arm_families();
/// An arm of the family with this seed.
[[nodiscard]] ArmModel draw_arm(const std::string& family, std::uint64_t seed);

/// How the arm is on one day: temperature moves gain by up to 1 %, friction by up to 8 % (standard
/// deviations drawn once an arm), weight a little.
struct ArmDays {
  double gain = 0.0, friction = 0.0,
         weight_n = 0.0;  ///< standard deviations; the first two as shares
};
[[nodiscard]] ArmDays draw_days(std::uint64_t seed);
[[nodiscard]] ArmModel on_a_day(const ArmModel& arm, const ArmDays& days, std::uint64_t seed);

/// A hand that holds the stylus, from lightly to firmly, and trembles.
[[nodiscard]] ArmHand draw_hand(std::uint64_t seed);

/// A check of it by a computer whose ticks are uneven by `uneven` of a period (uniform), and 4 ms
/// late once in 2000.
[[nodiscard]] ArmFigures check_free_arm(FreeArm& arm, std::uint64_t seed, double uneven = 0.2);

/// One station whose checks were learnt, then tried as it was and with two hidden changes.
struct StationTrial {
  int learnt = 0;            ///< checks that count
  int doubtful = 0;          ///< of those while it learnt and as it was
  int unchanged_checks = 0;  ///< as it was
  int false_alarms = 0;      ///< of those
  std::string false_alarm;   ///< quantity and axis of the last one
  bool friction_found = false, friction_doubtful = false,
       gain_named_too = false;  ///< at +0.1 N in each joint
  bool gain_found = false, gain_doubtful = false, friction_named_too = false;  ///< at -10 %
  std::string gain_cause;    ///< gain, mass, "gain or mass"
  bool hand_unseen = false;  ///< as it was, with a hand on it: called unchanged
  double longest_s = 0.0;    ///< of all checks
};
/// Learns `checks` times, each on another day; then `unchanged` checks as it was, one with 0.1 N
/// more in each joint, one with nine tenths of the gain.
[[nodiscard]] StationTrial try_station(const std::string& family, std::uint64_t seed, int checks,
                                       int unchanged);

}  // namespace cavum::testing_selfcheck
