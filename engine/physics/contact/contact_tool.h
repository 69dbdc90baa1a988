// A bur made ready for contact: its whole surface (head, neck, shank) as weighted samples in
// small patches, so that patches in free air cost nothing.
#pragma once

#include <vector>

#include "engine/physics/bur/bur.h"

namespace cavum {

/// A place on the surface in the tool frame.
struct ToolSample {
  Vec3 at_mm;
  Vec3 normal;          ///< unit, outwards
  double area_mm2 = 0;  ///< of the surface it stands for
};

/// Neighbouring samples with a ball around them.
struct ToolPatch {
  Vec3 centre_mm;
  double radius_mm = 0;
  std::uint32_t first = 0, last = 0;  ///< samples [first, last)
  double lever_mm = 0;                ///< furthest sample from the tip: how far a turn moves it
};

/// A piece of the felt outline where its normal turns, in the (r, z) half plane: the arc of a ball
/// end, the fillet of an edge, or a sharp tip (radius 0). `from` and `to` are the outward normals
/// at its ends, counter-clockwise.
struct TurningPiece {
  ProfilePoint centre, from, to;
  double radius_mm = 0;
};

struct ContactTool {
  Bur bur;
  std::vector<ToolSample> samples;
  std::vector<ToolPatch> patches;
  std::vector<TurningPiece> turning;  ///< of the coated head
  std::uint32_t head_patches = 0;     ///< the first patches are the coated head
  double reach_mm = 0;                ///< furthest sample from the tip

  /// The place on the coated head, as it is felt, that lies furthest along `way` (unit, tool
  /// frame): where a plane with normal -way touches it. The head is convex, so there is one, exact
  /// however far apart the samples are.
  [[nodiscard]] Vec3 furthest_along(Vec3 way) const noexcept;
};

/// Spreads samples at about `head_spacing_mm` (up to twice that on long heads) over the coated
/// head, at 0.27 mm elsewhere. Each sample sits at a height of its own, so that no ring of them
/// crosses a border in the same tick.
[[nodiscard]] ContactTool make_contact_tool(const Bur& bur, double head_spacing_mm = 0.09);

}  // namespace cavum
