// The programs of the graphics card, in GLSL 3.30. All light is worked out in the tooth frame, in
// linear colours; the last line of each turns them into what a screen shows.
#pragma once

#include <string>

namespace cavum::station {

/// The tooth. Defines: TAPS (1, 4, 9) of the shadow, REFLECTIONS, TOOL (an instrument stands near
/// and is seen to touch).
[[nodiscard]] std::string tooth_vertex();
[[nodiscard]] std::string tooth_fragment();
/// Instruments. Defines: as above, without TOOL.
[[nodiscard]] std::string metal_vertex();
[[nodiscard]] std::string metal_fragment();
/// Depth alone, as the lamp sees it.
[[nodiscard]] std::string depth_vertex();
[[nodiscard]] std::string depth_fragment();
/// Bodies in the colours of their corners, and tissue as clear as glass.
[[nodiscard]] std::string plain_vertex();
[[nodiscard]] std::string plain_fragment();
[[nodiscard]] std::string glass_vertex();
/// Drops and chips in the air, round and soft.
[[nodiscard]] std::string drop_vertex();
[[nodiscard]] std::string drop_fragment();
/// Edges of a finished picture made smooth: where the brightness jumps, the pixel is mixed with
/// those along the edge.
[[nodiscard]] std::string smooth_fragment();

}  // namespace cavum::station
