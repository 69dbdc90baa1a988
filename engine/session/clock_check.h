// What the clocks in a recording say of how the exam was sat: whether the computer slept, whether
// time ran slower for the hand than on the wall, and whether somebody set the clock. A simulated
// candidate may well be faster than real time; what a hand is said to have done may not.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/session/session_reader.h"

namespace cavum {

/// One stretch of a recording in which the clocks disagree.
struct ClockRemark : Damage {
  std::int64_t first_tick = 0, ticks = 0;
  bool doubtful = false;  ///< no honest exam of a hand looks so: a finding when it is filed as one
};

/// Doubtful: a suspend (boot ran on, monotonic stood) of more than 0.5 s, a wall clock that was set
/// by more than 2 s, clocks that ran backwards, ticks that are ahead of the clock by more than a
/// second and 2 % (recorded faster than real time), and lost time of more than 2 s in all that the
/// recording does not own up to (servo_gap). Remarks: ticks that took more than 1.25 times as long
/// as they say and half a second besides; each interruption that was recorded, with its length and
/// what the exam was taken up with.
[[nodiscard]] std::vector<ClockRemark> check_clocks(const SessionReader& session);

/// Time that the servo itself recorded as lost (`servo_gap`), s.
[[nodiscard]] double admitted_lost_s(const SessionReader& session);

}  // namespace cavum
