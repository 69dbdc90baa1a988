// The force that solid tissue would give: an observer that follows the measured force and, when
// that falls, says how much of it the tip's own motion explains. In solid tissue F = k X, the tip
// presses X further in by its advance, and the surface recedes from it at X / τ:
//
//     dG/dt = k · advance - G / τ,   G >= F,   G <= the level
//
// (docs/physics.md section 12). The level bounds G where k is only guessed at; once the force
// falls, a tip that goes on would press in further, and the bound no longer holds (`pressed_n`).
// Whatever the hand does - eases off, lifts, stops, is drawn back by its own friction - moves F and
// G alike; what is left of F / G is the work of the tissue. It is a cumulative sum of the
// unexplained losses of force, which cutting itself makes forget.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "grading/perforation/drill_frames.h"

namespace cavum::grading {

struct ExpectedForceSettings {
  double stiffness_n_per_mm = 0.8;  ///< k before anything was measured (docs/physics.md section 2)
  double worth_mm2 =
      0.012;  ///< weight of that, as a sum of squared steps of the tip: three seconds of drilling
  double least_stiffness_n_per_mm =
      0.6;  ///< what was measured below it was half cavity, or no contact
  double most_stiffness_n_per_mm = 1.2;  ///< what was measured above it was damping
  double learns_s = 4.0;                 ///< the measured k forgets its past so fast
  double back_share = 1.3;    ///< a retreat explains so many times k x its length: k is uncertain
  double forth_share = 1.0;   ///< an advance raises G by k x its length
  double tau_s = 2.02;        ///< τ of hard tissue (docs/physics.md section 2)
  double level_s = 0.5;       ///< the level: median of the force over so long ...
  double level_gap_s = 0.04;  ///< ... ending so long before now ...
  double level_memory_s =
      3.0;  ///< ... the highest within this time: a fall that takes longer is none
  double pressed_most =
      2.0;  ///< in a fall the tip's advance raises the expectation to so many levels
};

/// Median of the last values.
class RunningMedian {
 public:
  explicit RunningMedian(std::size_t n) : window_(n) { sorted_.reserve(n); }
  void add(double v);
  void clear();
  [[nodiscard]] bool ready() const noexcept { return 2 * sorted_.size() >= window_.size(); }
  [[nodiscard]] double value() const noexcept { return sorted_[sorted_.size() / 2]; }

 private:
  std::vector<double> window_, sorted_;
  std::size_t count_ = 0;
};

class ExpectedForce {
 public:
  explicit ExpectedForce(const ExpectedForceSettings& settings);
  /// Takes frame `i`, one after the other. A frame in which nothing can be cut forgets the level.
  void take(std::span<const DrillFrame> frames, std::int64_t i);
  /// Forgets the level: a new one has to build up.
  void forget();

  [[nodiscard]] bool ready() const noexcept { return median_.ready(); }
  [[nodiscard]] double force_n() const noexcept { return force_n_; }        ///< F, mean over 30 ms
  [[nodiscard]] double expected_n() const noexcept { return expected_n_; }  ///< G
  /// G of a tip that presses on in a fall: beyond the level, for solid tissue (or softer, in
  /// proportion) would give that
  [[nodiscard]] double pressed_n() const noexcept { return std::max(pressed_n_, expected_n_); }
  /// F while nothing of it was missing, mean over 50 ms
  [[nodiscard]] double held_n() const noexcept { return held_n_; }
  [[nodiscard]] double level_n() const noexcept { return level_n_; }
  [[nodiscard]] double stiffness_n_per_mm() const noexcept {
    return std::clamp((along_ + k_.worth_mm2 * k_.stiffness_n_per_mm) / (square_ + k_.worth_mm2),
                      k_.least_stiffness_n_per_mm, k_.most_stiffness_n_per_mm);
  }
  [[nodiscard]] Vec3 out() const noexcept {
    return out_;
  }  ///< unit, of the force while it held: out of the tooth

 private:
  ExpectedForceSettings k_;
  RunningMedian median_;
  std::deque<std::pair<std::int64_t, double>>
      levels_;                  // recent medians that no later one exceeds, falling
  std::deque<double> waiting_;  // forces younger than the gap
  Vec3 out_{0, 0, 1}, tip_mm_;
  double force_n_ = 0, expected_n_ = 0, pressed_n_ = 0, level_n_ = 0, held_n_ = 0;
  double along_ = 0, square_ = 0;  // of the stiffness: sums of step x change of force, and of step²
  bool fresh_ = true;
};

}  // namespace cavum::grading
