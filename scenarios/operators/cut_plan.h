// The way of a bur, held along the zones' approach, that removes the target and nothing else: from
// each column of the target along it how deep the whole bur may go, then layer by layer in closed
// loops from the inside out, and a last pass over the floor. The simulated candidate follows it;
// `scenario solve` proves with it that a task can be passed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/operators/reach_map.h"

namespace cavum::scenarios {

struct Waypoint {
  Vec3 tip_mm;
  bool cut = false;      ///< pedal pressed on the way to it
  bool careful = false;  ///< void tissue (pulp) lies close before the tip: press lightly
  std::uint8_t bur = 0;  ///< mounted on the way to it, of the tray
};

struct PlanOptions {
  double layer_mm = 2.0;            ///< depth of a layer
  double spacing_mm = 0.7;          ///< between the loops of a layer
  double finish_spacing_mm = 0.35;  ///< between the loops of the floor pass
  double tolerance_mm = 0.02;       ///< of the loops' corners
};

/// Waypoints from above the tooth and back; empty when the bur fits nowhere into the target.
[[nodiscard]] std::vector<Waypoint> plan_cut(const ReachMap& reach, const Tooth& tooth,
                                             const PlanOptions& options);

/// Along the approach through the flattest place of the roof over a tissue named in `aims` (of
/// equals the highest), and out again; empty without one. There a hand feels the chamber open: into
/// a pointed horn the head sinks by and by.
[[nodiscard]] std::vector<Waypoint> plan_pilot(const ReachMap& reach, const Tooth& tooth,
                                               double head_radius_mm,
                                               const std::vector<std::string>& aims);
/// Straight on from the floor of the target at the place where a tissue named `fault` lies closest
/// below it, to 0.8 mm beyond its surface: the way of a careless candidate. Empty when none lies
/// within 6 mm.
[[nodiscard]] std::vector<Waypoint> plan_perforation(const ZoneMap& zones, const Tooth& tooth,
                                                     const ReachMap& reach, std::uint8_t fault);

}  // namespace cavum::scenarios
