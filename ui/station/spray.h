// Water from the handpiece and what the head throws off, as they are seen: drops along three jets,
// mist around the head, chips in the tissue's colour. For the eye alone: where each drop is follows
// from its number and the time, nothing is kept of it, and nothing of it reaches tooth or physics.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "ui/station/gpu.h"

namespace cavum::station {

/// What flies now.
struct Spray {
  double time_s = 0.0;  ///< stands while nothing flies
  float water = 0.0F;   ///< 0..1
  float chips = 0.0F;   ///< 0..1
  glm::vec3 chip_colour{1.0F};
  friend bool operator==(const Spray&, const Spray&) = default;
};

/// A picture later: water runs while the bur turns, chips fly while it cuts; both take a moment to
/// come and to go. Shares of what is cut: 0..1.
void spray_on(Spray& spray, double rpm, bool cutting, double enamel_share, double dentin_share,
              double frame_s);

/// At most `count` drops for a head of this radius, tool frame (tip at 0, handpiece towards +z),
/// mm. None when nothing flies.
[[nodiscard]] std::vector<GpuDrop> drops_of(const Spray& spray, double head_radius_mm, int count);

inline constexpr float k_spray_reach_mm = 6.0F;  ///< from the instrument's axis
inline constexpr float k_jets_from_mm =
    11.0F;  ///< height of the jets' mouths above the tip: the handpiece's underside

}  // namespace cavum::station
