// The motion of a blind recording and everything known beside it: six sessions of about 47 s with
// air strokes and reversals, four speeds, holds, spindle off and on, three postures, several
// approach angles, the first site repeated last. It is drawn at 1 kHz and recorded at 200 Hz.
#pragma once

#include <cstddef>
#include <vector>

#include "tests/blind/draw.h"

namespace cavum::blind {

inline constexpr double k_step_s =
    0.001;  ///< of the fine grid on which mechanisms with a memory are integrated
inline constexpr std::size_t k_rows_per_row = 5;  ///< fine steps per recorded row: 200 Hz

/// One entry per fine step in each vector; all have the same length. `x_mm` is negative in air,
/// `v_mm_s` positive = deeper.
struct Motion {
  std::vector<int> session;  ///< 1 .. 6
  std::vector<double> t_s;   ///< from the start of its session
  std::vector<double> x_mm, v_mm_s, a_mm_s2;
  std::vector<double> spindle_rpm, wet, posture_deg, approach_deg, fy_n, fz_n;
  std::vector<double> removed_mm3;  ///< since bur 1 was new; goes on rising when the bur is changed
  std::vector<double> worn_mm3;     ///< since the bur in use was new; not recorded
  std::vector<double> bur_id, site, temperature_c;
  std::vector<double> other;      ///< a slow quantity that no mechanism knows
  std::vector<double> phase_rad;  ///< one per session, of anything periodic

  [[nodiscard]] std::size_t size() const { return t_s.size(); }
  [[nodiscard]] bool touching(std::size_t i) const { return x_mm[i] > 0.0; }
};

/// Six sessions with everything that separates the mechanisms.
[[nodiscard]] Motion six_sessions(Draw& draw);

/// What a testing machine does: each session one feed at the same constant speed, in contact from
/// first to last, spindle on, one posture.
[[nodiscard]] Motion crosshead(Draw& draw);

}  // namespace cavum::blind
