// The walls of a cavity by name: what measures are called by, and what zones are told apart by.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/base/text.h"

namespace cavum::scenarios {

/// Towards where the target's nearest surface faces. The opening (occlusal) is no wall.
enum class Wall : std::uint8_t { mesial, distal, buccal, lingual, floor, opening };
inline constexpr std::size_t k_walls = 5;
inline constexpr std::size_t k_side_walls = 4;  ///< the first of them; the floor comes after
[[nodiscard]] constexpr const char* wall_name(Wall wall) noexcept {
  constexpr const char* k_names[] = {noop("mesial"),  noop("distal"), noop("buccal"),
                                     noop("lingual"), noop("floor"),  noop("opening")};
  return k_names[static_cast<std::size_t>(wall)];
}

}  // namespace cavum::scenarios
