// Landmarks drawn over the tooth: from above, and from two sides through enamel, dentin and pulp.
#pragma once

#include <string>

#include "engine/tooth/anatomy/landmarks.h"

namespace cavum::ui {

/// One SVG file, millimetres of the tooth frame on its axes.
[[nodiscard]] std::string landmark_picture(const Tooth& tooth, const Landmarks& landmarks);

}  // namespace cavum::ui
