// Caries under a sound surface: softened dentin in an ellipsoid inside a tooth of our own. Only
// labels change, so the surface stays what it was; what is softer there is said by the material set
// (data/materials: lesion).
#pragma once

#include "engine/tooth/tooth.h"

namespace cavum {

/// An ellipsoid with axes along the tooth frame, mm.
struct LesionShape {
  Vec3 centre_mm, radii_mm;
};

/// The tooth with its dentin inside the ellipsoid turned to a solid tissue `lesion`; enamel stays
/// sound. Throws Error when a radius is not positive, no dentin lies there, or the lesion would not
/// be hidden: it must touch neither air nor pulp nor any other void tissue.
[[nodiscard]] Tooth plant_lesion(Tooth tooth, const LesionShape& lesion);

}  // namespace cavum
