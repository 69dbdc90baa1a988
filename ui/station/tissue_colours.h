// The colours of tissues, which engine/tooth/tissues.h has, in clear light: the picture's and the
// key's beside it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/tooth/tissues.h"

namespace cavum::station {

/// Of what is to be removed: red, green, blue, opaque.
inline constexpr std::array<std::uint8_t, 4> k_target_colour{60, 190, 235, 255};

/// By its name, as shown on the screen (sRGB, 0..1).
[[nodiscard]] glm::vec3 tissue_colour(std::string_view tissue, bool high_contrast);

}  // namespace cavum::station
