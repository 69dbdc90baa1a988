// Reading many teeth that are one tooth drilled in different places: what reading the first found
// out serves the others.
#pragma once

#include <span>
#include <string>

#include "engine/tooth/packed_octree.h"
#include "engine/tooth/tooth.h"

namespace cavum {

/// As `load_tooth`, to the same tooth. `like`, unless null, is of a tooth that is much the same:
/// most of what reading would work out is taken from there. `keep` receives that of this tooth.
[[nodiscard]] Tooth load_tooth_like(std::span<const std::uint8_t> bytes, const std::string& where,
                                    const PackedFits* like, KnownFits* keep = nullptr);

}  // namespace cavum
