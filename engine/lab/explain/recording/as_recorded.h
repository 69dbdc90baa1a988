// What positions and speeds tell as they stand in the recording, before any motion is estimated
// from them: steps, scatter, and how the two agree.
#pragma once

#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

/// Sampling interval of one row to the next, s; of the session's last row the one before.
[[nodiscard]] Series intervals_s(const Recording& recording);
/// Step that all positions are multiples of, mm; 0 when the data show none coarser than 1e-5 of
/// their range.
[[nodiscard]] double seen_quantum_mm(const Recording& recording);
/// How far the position moves over the integral of the measured speed: slope and correlation over
/// short spans, those spent cutting (in contact and spinning) apart from all others. Zero where
/// there is no such motion or no measured speed.
struct Agreement {
  double slope = 0, correlation = 0;  ///< not cutting
  double cutting_slope = 0;  ///< cutting: below 1 when x_mm counts from a surface that recedes
  double slope_sd = 0, expected_correlation = 1;  ///< what the steps of the encoder leave of both
};
[[nodiscard]] Agreement position_over_speed(const Recording& recording);
/// True when x_mm counts from a surface that is cut away under the tool: then the measured speed is
/// the tip's, and no derivative of x.
[[nodiscard]] bool surface_recedes(const Recording& recording);
/// Scatter of the positions from row to row, mm, from their fourth differences, which a smooth
/// motion hardly has; `quantum_mm` of rounding taken off. 0 where nothing is seen beside the
/// rounding.
[[nodiscard]] double position_noise_mm(const Recording& recording, double quantum_mm);
/// Correlation of a speed's fine structure with the error of the position from which on it was made
/// from the positions.
inline constexpr double k_borrowed = 0.1;
/// How the recorded speed stands to the position.
struct SpeedCheck {
  double late_s = 0, late_sd_s = 0;  ///< the speed behind the position
  double borrowed = 0;  ///< correlation of its fine structure with the error of the position: 0
                        ///< when it was measured by itself
  bool of_use = false;  ///< neither late nor made from the positions
};
[[nodiscard]] SpeedCheck check_speed(const Recording& recording);
/// Scatter of a measured speed from its third differences, mm/s, which a smooth motion hardly has
/// (20 = 1 + 9 + 9 + 1).
[[nodiscard]] double speed_scatter_mm_s(const Recording& recording);

}  // namespace cavum::explain
