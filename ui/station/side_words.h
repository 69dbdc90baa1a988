// Which side of the crown is which, in words at its four sides: they follow the camera, and never
// stand over the cavity.
#pragma once

#include <imgui.h>

#include <functional>
#include <vector>

#include "engine/base/vec.h"
#include "engine/tooth/tooth.h"
#include "scenarios/zones/zone_map.h"
#include "ui/station/camera.h"
#include "ui/station/theme.h"

namespace cavum::station {

/// Boxes of the tooth frame, mm.
struct CrownSides {
  Vec3 low, high;                ///< of the crown with the cavity
  Vec3 cavity_low, cavity_high;  ///< of what is to be removed
  bool anterior = false;         ///< of a front tooth: labial for buccal
};
/// Of a tooth before anything was cut. Without enamel the whole tooth counts as its crown.
[[nodiscard]] CrownSides crown_sides(const Tooth& tooth, const scenarios::ZoneMap& zones);

/// A word in the picture.
struct SideWord {
  Message word;         ///< "mesial"
  ImVec2 middle, size;  ///< pixels from the picture's upper left corner
  Vec3 towards;         ///< its side, in the tooth's axes
};
/// Those that have a place beside the crown in a picture of this size, pixels, as one or the other
/// eye sees it (Camera::view). A side that looks at the eye or away from it has none, nor has one
/// whose only place would be over the cavity. `size_of`: of a word, as it is shown; `apart`:
/// between a word and the crown, and the picture's edge.
[[nodiscard]] std::vector<SideWord> side_words(
    const CrownSides& sides, const Camera& camera, int eye, ImVec2 picture, float apart,
    const std::function<ImVec2(const Message&)>& size_of);

/// Into a picture at a place of the screen.
void draw_side_words(const Theme& theme, const CrownSides& sides, const Camera& camera, bool stereo,
                     ImVec2 at, ImVec2 size);

}  // namespace cavum::station
