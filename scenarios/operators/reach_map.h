// How deep a bur, held along the zones' approach, may go in each column of the target without
// cutting what must stay: a bur is an upright body of revolution, which fits where no height of the
// way in is narrower than it.
#pragma once

#include <vector>

#include "engine/base/pose.h"
#include "engine/physics/contact/contact_tool.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {

/// How far an expert lets the bur reach beyond the target's surface.
inline constexpr MarginSpec k_expert_margin{0.03, 0.03};

/// Columns of the target seen along the approach, and how low the tip may go in each. Heights and
/// columns are those of the tool's frame, turned about the tooth's origin; upright, that is the
/// tooth frame.
struct ReachMap {
  int nx = 0, ny = 0;
  double step_mm = 0.1;
  Mat3 tool;                         ///< from the tool's frame to the tooth's
  double bottom_mm = 0, top_mm = 0;  ///< heights between which the target lies
  Vec3 origin_mm;  ///< centre of column (0,0); z = height to start from, above the tooth
  std::vector<double>
      lowest_mm;  ///< lowest tip height; k_unreachable where the bur does not fit at all

  static constexpr double k_unreachable = 1e9;
  [[nodiscard]] std::size_t index(int x, int y) const noexcept {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x);
  }
  /// A place in the tooth frame.
  [[nodiscard]] Vec3 at(int x, int y, double z) const noexcept {
    return tool * Vec3{origin_mm.x + x * step_mm, origin_mm.y + y * step_mm, z};
  }
};
/// How wide the way into the target is at each place, whatever the bur: made once for a tray.
struct FreeRoom {
  ReachMap map;  ///< all columns unreachable
  double base_mm = 0, step_mm = 0.1;
  int slices = 0;                ///< heights from base_mm upwards
  std::vector<float> free_mm{};  ///< radius, height after height, columns as in `map`
  std::vector<std::uint8_t>
      target{};  ///< 1 where there is target to remove, from map.bottom_mm + step_mm / 2 upwards
};
/// `margin` is how far a bur may reach beyond the target's sides and bottom (negative: stay away
/// from them).
[[nodiscard]] FreeRoom free_room(const ZoneMap& zones, const Tooth& tooth,
                                 const MarginSpec& margin);
[[nodiscard]] ReachMap reach_map(const FreeRoom& room, const ZoneMap& zones, const Tooth& tooth,
                                 const ContactTool& tool);
/// For one bur alone.
[[nodiscard]] ReachMap reach_map(const ZoneMap& zones, const Tooth& tooth, const ContactTool& tool,
                                 const MarginSpec& margin);

/// The same map without places where the bur would stand high on sound tooth and remove nothing
/// that it does not remove from places at least a millimetre deeper: on a slope beside the cavity
/// it slips.
[[nodiscard]] ReachMap without_skimming(const FreeRoom& room, ReachMap reach,
                                        const ContactTool& tool);

/// The same map for who opens only the middle: `percent` of the length and width over which the bur
/// may go.
[[nodiscard]] ReachMap middle_of(ReachMap reach, double percent);

/// Share of the target, 0..1, that the bur can remove when its tip goes everywhere the map allows.
[[nodiscard]] double coverage(const FreeRoom& room, const ReachMap& reach, const ContactTool& tool);

}  // namespace cavum::scenarios
