// A cavity in the buccal or lingual side of a crown, told by the neck: its outline is seen straight from that side, its axial wall follows the
// surface.
#pragma once

#include <memory>
#include <string>

#include "engine/base/message.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "scenarios/zones/shape.h"

namespace cavum::scenarios {

struct PlacedSideCavity {
  std::unique_ptr<Shape> body;
  Vec3 way;  ///< in, pointing out of the tooth: the mean normal of the surface inside the outline, without its part along x; within 29 degrees of y
};

/// Points of the outline: x from the neck's middle towards mesial, y above the neck, mm, where it meets the surface in its middle. Heights count from
/// the neck below each place, so that a rectangle bends with it (a kidney), or from its middle (`level`). Walls run straight in along the way; the
/// axial wall lies `depth_mm` below the surface, square to it. Open outwards; nothing beyond the tooth's long axis. Throws Error when the tooth shows
/// no neck on that side, or the outline lies beside it.
[[nodiscard]] PlacedSideCavity side_cavity(const Tooth& tooth, const ShapeSpec& spec, const Landmarks& landmarks, const Message& where,
                                           ZoneWork& work);

}  // namespace cavum::scenarios
