// The colours of tissues in clear light: the picture's and the key's beside it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/tooth/tissue_grid.h"

namespace cavum::station {

/// Of what is to be removed: red, green, blue, opaque.
inline constexpr std::array<std::uint8_t, 4> k_target_colour{60, 190, 235, 255};

/// As shown on the screen (sRGB, 0..1). Told apart by lightness as well as by hue, for eyes that see no red or green.
[[nodiscard]] glm::vec3 tissue_colour(const Tissue& tissue, bool high_contrast);

}  // namespace cavum::station
