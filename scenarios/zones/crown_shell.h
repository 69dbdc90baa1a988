// What a full crown takes the place of: everything outside a tapered stump, above a finish line that follows the neck.
#pragma once

#include <memory>
#include <string>

#include "engine/base/message.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "scenarios/zones/relief.h"
#include "scenarios/zones/shape.h"

namespace cavum::scenarios {

/// The stump stands along +z about the middle of the neck. Its finish line runs `above_neck_mm` above the neck (its waves smoothed over 35 degrees)
/// on the outer surface; from there a quarter circle of radius `depth_mm` leads in (chamfer), then the wall leans inwards by `taper_deg`. Everywhere
/// it stays `depth_mm` below the outer surface, and under the occlusal surface (smoothed over 0.5 mm) by `occlusal_mm` square to its slope.
/// `surface`: the tooth's relief from above. Throws Error when the tooth shows no neck, or none of its surface at the finish line.
[[nodiscard]] std::unique_ptr<Shape> crown_shell(const Tooth& tooth, const ShapeSpec& spec, const Landmarks& landmarks, const ColumnMap& surface,
                                                 const Message& where, ZoneWork& work);

}  // namespace cavum::scenarios
