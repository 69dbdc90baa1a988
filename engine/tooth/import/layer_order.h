// The pulp lies in dentin and touches hardly anything else, in every tooth: what it touches tells whether enamel,
// dentin and pulp are what the user says they are. Meshes and label maps are judged by the same rule.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/vec.h"

namespace cavum {

/// Faces between a pulp cell and its six neighbours, by the neighbour's tissue. Faces on the lattice's border do not count.
[[nodiscard]] std::array<std::uint64_t, 256> pulp_faces(IVec3 size, const std::vector<std::uint8_t>& tissue);

/// Throws Error when the pulp lies in the enamel: more of its faces are on enamel than on dentin, and no fewer than on air.
void require_layer_order(const std::array<std::uint64_t, 256>& faces, const std::string& where, const std::string& what_to_do);

}  // namespace cavum
