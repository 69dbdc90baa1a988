// How large the walls of a target are, leaf by leaf: of what hard tissue leaves of them, and where
// they are thinner than the leeway.
#pragma once

#include <array>

#include "engine/tooth/tooth.h"
#include "scenarios/file/wall.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {

/// By Wall, mm2.
using WallAreas = std::array<double, k_walls>;

/// Hard tissue of the tooth alone (`own`) that stands beside the target.
[[nodiscard]] WallAreas hard_walls_mm2(const Tooth& own, const ZoneMap& zones);

/// Walls that end in the air before the leeway does. A shell that is left before a neighbour is
/// none, nor is what lies so near the surface that a wall is a slope there, nor the floor where a
/// finish line lies on the outer surface.
[[nodiscard]] WallAreas thin_walls_mm2(const ZoneSpec& spec, const Tooth& tooth, const Tooth& own,
                                       const ZoneMap& zones);

}  // namespace cavum::scenarios
