// The leaves of a section in their colours: tissues, what was removed, and from above the shade of
// the slopes.
#pragma once

#include <string>

#include "scenarios/review/picture_colours.h"
#include "scenarios/review/section.h"

namespace cavum::scenarios {

/// One SVG path for each colour, in leaf units.
[[nodiscard]] std::string section_leaves_svg(const Section& section, const PictureSpec& spec,
                                             const Palette& colours);

}  // namespace cavum::scenarios
