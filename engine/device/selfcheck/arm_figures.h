// What a station finds of its own stylus, from commanded force and measured place alone. Forces and
// masses are therefore per newton commanded: a motor that gives nine tenths of what it is told
// makes friction and mass seem a ninth larger. docs/selfcheck.md has the equations.
#pragma once

#include <array>
#include <string>

#include "engine/base/message.h"

namespace cavum {

/// Along one axis of the stylus's own frame.
struct ArmAxis {
  double friction_n =
      0.0;  ///< half the width of the loop of force over place in a slow drag, N commanded
  double friction_error_n = 0.0;  ///< its standard error, from the passes of this check
  double mass_kg = 0.0;           ///< apparent mass: N commanded for each m/s²
  double mass_error = 0.0;        ///< its standard error, as a share of it
  double weight_n = 0.0;  ///< force commanded on average to go forth and back: weight and springs
                          ///< that nothing balances
};

struct ArmFigures {
  std::array<ArmAxis, 3> axes;
  double quantum_mm =
      0.0;               ///< a small step of the places that it told: 5 % of the steps are smaller
  double rate_hz = 0.0;  ///< readings of the device in a second
  double jitter_ms = 0.0;     ///< standard deviation of their periods, since it was opened
  double tick_mean_ms = 0.0;  ///< periods of the loop that checked it
  double tick_p99_ms = 0.0, tick_worst_ms = 0.0;
  double ticks_missed = 0.0;  ///< share of periods longer than one and a half ticks
  double stale = 0.0;         ///< share of ticks without a fresh place
  double seconds = 0.0;       ///< that the check took
  bool dragged = false;       ///< friction holds, whatever the doubt says of the rest
  Message doubt;              ///< why the figures say nothing, and what to do; empty when they do

  [[nodiscard]] double friction_n() const noexcept {
    return (axes[0].friction_n + axes[1].friction_n + axes[2].friction_n) / 3.0;
  }
};

}  // namespace cavum
