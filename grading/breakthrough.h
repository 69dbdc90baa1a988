// The detector of breakthroughs. It sees what a device gives - rendered force, pose, pedal, speed, which point is mounted - and
// nothing of the tissue, so that it would work on a real tooth as well.
//
// While the handpiece turns and the tip cuts, the force along the push has a level. A breakthrough is a fall of that force to almost nothing
// while the tip does not give way: it goes on, or further, in the direction of the push. What else makes a force fall is told apart by where
// the tip goes and has been: a hand that eases off, or lifts, moves the tip back by what the tissue springs back; a released pedal stops the
// handpiece; softer tissue leaves a part of the force; a point that slips off an edge has not stayed long enough to have cut
// anything there; a cut into an earlier cavity leads to where the tip has moved freely before.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/servo/tick.h"

namespace cavum {

struct BreakthroughSettings {
  double sure_from = 0.5;          ///< events below this sureness are left out, 0..1
  double least_level_n = 0.08;     ///< a force below it tells nothing
  double opens_at = 0.5;           ///< of the level: a fall that far is looked at ...
  double rests_at = 0.09;          ///< ... and is as likely as not a breakthrough when it ends there
  double dated_at = 0.77;          ///< of the level: the event's time is the last moment the force still had it
  double level_s = 0.32;           ///< median of the force over this long ...
  double level_gap_s = 0.04;       ///< ... ending this long before now
  double level_memory_s = 1.6;     ///< the highest of those medians within this time is the level
  double longest_s = 1.2;          ///< a fall is watched for this long after it opened
  double give_way_mm = 0.11;       ///< a tip that goes back further than that against the push gives way
  double gives_mm = 0.06;          ///< nor may it have gone back by that much when the force is gone
  double confirm_s = 0.03;         ///< it must not give way so soon after the force is gone, either
  double withdrawal_mm = 0.15;     ///< one that moves further than that towards the handle is withdrawn
  double slips_mm_s = 1.2;         ///< one that wanders sideways faster than that before the fall slips
  int bounces = 2;                 ///< one whose force fell that often in the 0.8 s before bounces
  double least_advance_mm = 0.12;  ///< of the tip along the push
  double strays_mm = 0.25;         ///< one that has gone sideways by more than that ...
  double strays_share = 0.5;       ///< ... and this share of its advance, when the force is gone, fell off something
  double dwell_s = 0.38;           ///< it must have cut so long ...
  double dwell_mm = 0.5;           ///< ... within this distance
  double air_n = 0.04;             ///< below that the tip moves freely
  double near_air_mm = 0.45;       ///< beside a place where it moved freely before, it falls into an earlier cavity
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
