// The detector of breakthroughs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "grading/expected_force.h"

namespace cavum {

struct BreakthroughSettings {
  double sure_from = 0.5;          ///< events below this sureness are left out, 0..1
  double least_level_n = 0.07;     ///< a force below it tells nothing
  ExpectedForceSettings expected;
  double opens_at = 0.5;           ///< of the expected force
  double closes_at = 0.7;
  double dated_at = 0.77;
  double held = 0.5;          ///< of the level: a fall counts while the tip's motion explains no more than the rest
  double void_rest = 0.12;   ///< what a cavity leaves of the expected force: half normal with this scale
  double soft_odds = 2;
  double confirm_s = 0.03;
  double chatter = 0.35;
  double slips_mm_s = 1.2;
  double strays_mm = 0.25;
  double strays_share = 0.5;
  double least_advance_mm = 0.0;
  double dwell_s = 0.38;
  double dwell_mm = 0.5;
  double air_n = 0.25;
  double near_air_mm = 0.45;
};

/// One fall of the force.
struct Breakthrough {
  std::int64_t tick = 0;        ///< when it began
  std::int64_t seen_tick = 0;   ///< when the detector could say so
  double sureness = 0.0;        ///< 0..1; 0.5 = as likely as not
  double force_before_n = 0.0;  ///< the level
  double force_after_n = 0.0;   ///< the least mean over 30 ms in the fall
  double advance_mm = 0.0;      ///< of the tip along the push in the fall
};

/// In order of time. `inputs` and `records` have equal length, one entry per tick of 1 ms.
[[nodiscard]] std::vector<Breakthrough> find_breakthroughs(std::span<const TickInput> inputs, std::span<const TickRecord> records,
                                                           const BreakthroughSettings& settings = {});

}  // namespace cavum
