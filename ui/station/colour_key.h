// What the colours of the practice picture mean, written beside the tooth.
#pragma once

#include <vector>

#include "engine/tooth/tissue_grid.h"
#include "ui/station/theme.h"

namespace cavum::station {

struct ColourKeyEntry {
  ImVec4 colour;
  Message word;
};
/// What is to be removed first, then what the tooth itself consists of. In their tissue_colour.
[[nodiscard]] std::vector<ColourKeyEntry> colour_key(const std::vector<Tissue>& tissues,
                                                     bool high_contrast);
/// In the upper right corner of a picture, pixels.
void draw_colour_key(const Theme& theme, const std::vector<ColourKeyEntry>& key, ImVec2 at,
                     ImVec2 size);

}  // namespace cavum::station
