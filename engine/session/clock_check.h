// What the clocks in a recording say of how the exam was sat: whether the computer slept, whether time ran slower for the hand than on the wall, and
// whether somebody set the clock. All of it is evidence for people: a simulated candidate may well be faster than real time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/session/session_reader.h"

namespace cavum {

/// One stretch of a recording in which the clocks disagree.
struct ClockRemark {
  std::int64_t first_tick = 0, ticks = 0;
  std::string what;  ///< in words, with times
};

/// Suspends (boot ran on, monotonic stood), ticks that took more than 1.25 times as long as they say and half a second besides, wall clocks set by
/// more than 2 s, and a recording that is faster than real time as a whole. Each interruption that was
/// recorded is named with its length and what the exam was taken up with.
[[nodiscard]] std::vector<ClockRemark> check_clocks(const SessionReader& session);

}  // namespace cavum
