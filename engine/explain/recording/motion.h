// Where the tool really was, and how fast: position, speed and acceleration from a measured position that may be
// coarse. The simulator and every regressor use this one estimate, for a velocity of their own would be a false cause.
//
// A Kalman filter forwards and a Rauch-Tung-Striebel smoother backwards, state (x, v), v a random walk whose variance per
// second is found from the data and follows it in time (holds are quiet, reversals are not). An encoder of quantum q says:
// - while it shows one value, x lies within q/2 of it: one observation of variance q²/12, shared by
//   the rows of the run, by those of 0.4 s at most;
// - when it steps by one, x is at the border between the two: an observation nearly free of error. These carry the speed;
// - x never leaves the cell that is shown: where the estimate does, the border is observed.
// Source: Rauch, Tung, Striebel 1965; expectation maximisation of the walk's variance after Shumway and Stoffer 1982.
#pragma once

#include "engine/explain/recording/recording.h"

namespace cavum::explain {

/// Estimates, each of shape [rows].
struct Motion {
  Series x_mm, v_mm_s, a_mm_s2;
  Series sd_x_mm, sd_v_mm_s;   ///< one standard deviation
  double quantum_mm = 0.0;     ///< of the encoder: given, or seen in the data
  double speed_sd_mm_s = 0.0;  ///< scatter of the measured speed; 0 without a v column
};

/// Less than 1 % of the rows go back at a tenth of the fastest speed or more.
[[nodiscard]] bool moves_one_way(const Motion& motion);
/// Sampling interval of one row to the next, s; of the session's last row the one before.
[[nodiscard]] Series intervals_s(const Recording& recording);
/// Step that all positions are multiples of, mm; 0 when the data show none coarser than 1e-5 of their range.
[[nodiscard]] double seen_quantum_mm(const Recording& recording);
/// How far the position moves over the integral of the measured speed: slope and correlation over short spans, those spent
/// cutting (in contact and spinning) apart from all others. Zero where there is no such motion or no measured speed.
struct Agreement {
  double slope = 0, correlation = 0;              ///< not cutting
  double cutting_slope = 0;                       ///< cutting: below 1 when x_mm counts from a surface that recedes
  double slope_sd = 0, expected_correlation = 1;  ///< what the steps of the encoder leave of both
};
[[nodiscard]] Agreement position_over_speed(const Recording& recording);
/// True when x_mm counts from a surface that is cut away under the tool: then the measured speed is the tip's, and no derivative of x.
[[nodiscard]] bool surface_recedes(const Recording& recording);
/// All sessions. The measured speed is used when `recording` has one.
[[nodiscard]] Motion estimate_motion(const Recording& recording);
/// The same with speeds that change as suddenly as the data allow: the walk's variance is found for each row by itself, so that
/// a few rows take all of a change. Truer to sharp stops, less so to smooth motion; twins of a coarse recording move like this.
[[nodiscard]] Motion estimate_sharp_motion(const Recording& recording);

}  // namespace cavum::explain
