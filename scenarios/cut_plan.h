// The way of an upright diamond point that removes the target and nothing else: from each column of the
// target how deep the whole point may go, then layer by layer in closed loops from the inside out, and
// a last pass over the floor. The simulated candidate follows it; `scenario solve` proves with it that a
// task can be passed.
#pragma once

#include <vector>

#include "engine/contact/contact_tool.h"
#include "scenarios/zone_map.h"

namespace cavum {

struct Waypoint {
  Vec3 tip_mm;
  bool cut = false;      ///< pedal pressed on the way to it
  bool careful = false;  ///< void tissue (pulp) lies close before the tip: press lightly
};

struct PlanOptions {
  double layer_mm = 2.0;            ///< depth of a layer
  double spacing_mm = 0.7;          ///< between the loops of a layer
  double finish_spacing_mm = 0.35;  ///< between the loops of the floor pass
  double tolerance_mm = 0.02;       ///< of the loops' corners
  double margin_mm = 0.03;          ///< how far the point may reach beyond the target's surface
};

/// Columns of the target seen from above, and how low the tip may go in each.
struct ReachMap {
  int nx = 0, ny = 0;
  double step_mm = 0.1;
  Vec3 origin_mm;                 ///< centre of column (0,0); z = height to start from, above the tooth
  std::vector<double> lowest_mm;  ///< lowest tip height; k_unreachable where the point does not fit at all

  static constexpr double k_unreachable = 1e9;
  [[nodiscard]] std::size_t index(int x, int y) const noexcept {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] Vec3 at(int x, int y, double z) const noexcept { return {origin_mm.x + x * step_mm, origin_mm.y + y * step_mm, z}; }
};
[[nodiscard]] ReachMap reach_map(const ZoneMap& zones, const Tooth& tooth, const ContactTool& tool, double margin_mm);

/// Share of the target, 0..1, that the point can remove when its tip goes everywhere the map allows.
[[nodiscard]] double coverage(const ReachMap& reach, const ZoneMap& zones, const Tooth& tooth, const ContactTool& tool);

/// Waypoints from above the tooth and back; empty when the point fits nowhere into the target.
[[nodiscard]] std::vector<Waypoint> plan_cut(const ReachMap& reach, const ZoneMap& zones, const Tooth& tooth, const PlanOptions& options);

/// Straight down from the floor of the target at the place where a tissue named `fault` lies closest below it,
/// to 0.8 mm beyond its surface: the way of a careless candidate. Empty when none lies within 6 mm.
[[nodiscard]] std::vector<Waypoint> plan_perforation(const ZoneMap& zones, const Tooth& tooth, const ReachMap& reach, std::uint8_t fault);

}  // namespace cavum
