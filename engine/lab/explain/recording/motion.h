// Where the tool really was, and how fast: position, speed and acceleration from a measured
// position that may be coarse. The simulator and every regressor use this one estimate, for a
// velocity of their own would be a false cause.
//
// A Kalman filter forwards and a Rauch-Tung-Striebel smoother backwards, state (x, v), v a random
// walk whose variance per second is found from the data and follows it in time (holds are quiet,
// reversals are not). An encoder of quantum q says:
// - while it shows one value, x lies within q/2 of it: one observation of variance q²/12, shared by
//   the rows of the run, by those of 0.4 s at most;
// - when it steps by one, x is at the border between the two: an observation nearly free of error.
// These carry the speed;
// - x never leaves the cell that is shown: where the estimate does, the border is observed.
// Where the position is noisy instead (its fourth differences do not vanish, or the encoder
// flickers), each row is one observation with that variance.
//
// A recorded speed is one more observation of the same motion, of unknown filter and delay. Where
// the position alone is good enough it is not needed; where it is late, or was made from the
// positions, it is not used, and a note says so. Source: Rauch, Tung, Striebel 1965; expectation
// maximisation of the walk's variance after Shumway and Stoffer 1982.
#pragma once

#include <utility>
#include <vector>

#include "engine/base/fact.h"
#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

/// Estimates, each of shape [rows].
struct Motion {
  Series x_mm, v_mm_s, a_mm_s2;
  Series sd_x_mm, sd_v_mm_s;  ///< one standard deviation
  Series lasting_rows;  ///< how many rows an error of the position lasts, >= 1: as long as a coarse
                        ///< encoder shows one value
  double quantum_mm = 0.0;  ///< of the encoder: given, or seen in the data
  double noise_mm =
      0.0;  ///< of the position, from row to row, beside the quantum; 0 = not to be seen
  double speed_sd_mm_s = 0.0;  ///< scatter of the measured speed, where it was used
  std::vector<std::pair<Series, Series>>
      possible;     ///< x and v of a few motions that the recording leaves possible as well; empty
                    ///< where it leaves none
  Fact speed_note;  ///< why a measured speed was not used; empty = it was, or there is none
};

/// Less than 1 % of the rows go back at a tenth of the fastest speed or more.
[[nodiscard]] bool moves_one_way(const Motion& motion);
/// All sessions.
[[nodiscard]] Motion estimate_motion(const Recording& recording);
/// Motions that the recording leaves possible, drawn from what the smoother knows (forward filter,
/// backward sampling: Carter and Kohn 1994). Where a rig came back to the same places under a
/// coarse encoder, the places lie elsewhere within its cells, the same in all sessions. Numbers
/// [which.first, which.second) of those that a seed gives.
[[nodiscard]] std::vector<Motion> draw_motions(const Recording& recording, const Motion& estimate,
                                               std::pair<std::size_t, std::size_t> which,
                                               std::uint64_t seed);

}  // namespace cavum::explain
