// Where caries begins: a lesion placed on any tooth by its landmarks, under the fissure or under a
// contact area, and grown into its dentin.
#pragma once

#include <string>

#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/make/plant_lesion.h"

namespace cavum {

/// "occlusal" (under the central pit, else the middle of the fissure), "mesial" or "distal" (under
/// the contact area, or as far below it as the dentin begins), "buccal" or "lingual" (under the
/// height of contour).
struct LesionSite {
  std::string surface = "occlusal";
  double width_mm = 2.0;  ///< along the border of enamel and dentin, 0.5 to 6
  double depth_mm = 0.8;  ///< into dentin from that border, 0.2 to 4
};

/// The ellipsoid for `plant_lesion`: its middle on the border of enamel and dentin, half of it in
/// dentin. Throws Error when the surface's landmark is not found, a length is out of its range, or
/// there is no dentin under the enamel there.
[[nodiscard]] LesionShape place_lesion(const Tooth& tooth, const Landmarks& landmarks,
                                       const LesionSite& site);

}  // namespace cavum
