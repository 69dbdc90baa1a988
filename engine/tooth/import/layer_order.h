// The pulp lies in dentin and touches hardly anything else, in every tooth: what it touches tells whether enamel,
// dentin and pulp are what the user says they are. Meshes and label maps are judged by the same rule.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/vec.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum {

/// Faces between a pulp cell and its six neighbours, by the neighbour's tissue. Faces on the lattice's border do not count.
[[nodiscard]] std::array<std::uint64_t, 256> pulp_faces(IVec3 size, const std::vector<std::uint8_t>& tissue);

/// Throws Error when the pulp lies in the enamel: more of its faces are on enamel than on dentin, and no fewer than on air.
void require_layer_order(const std::array<std::uint64_t, 256>& faces, const std::string& where, const std::string& what_to_do);

/// Voids between enamel and dentin.
struct LayersApart {
  double share = 0.0;      ///< of the places where one faces the other along an axis, those with a void between them, 0 to 1
  double widest_mm = 0.0;  ///< the widest of those voids
};
/// Of a lattice before gaps are closed. Voids of more than 0.15 mm (and two leaves) up to 3 mm count.
[[nodiscard]] LayersApart layers_apart(const TissueGrid& grid);

/// Pulp that borders air more than 0.5 mm above the enamel's lowest place.
struct OpenPulp {
  double mm2 = 0.0;
  Vec3 at_mm;  ///< one of its places
};
/// Of a lattice whose +z is occlusal, before periodontium is added.
[[nodiscard]] OpenPulp open_pulp(const TissueGrid& grid);

/// Dentin that borders air in the crown, more than 1 mm above the lowest enamel of its direction.
struct BareDentin {
  double mm2 = 0.0;          ///< in all
  double largest_mm2 = 0.0;  ///< of the largest place that hangs together
  Vec3 at_mm;                ///< the middle of that place
};
/// Of a lattice whose +z is occlusal.
[[nodiscard]] BareDentin bare_dentin(const TissueGrid& grid);

/// Throws Error when dentin and enamel stand apart, or one lies in the other by more than a tenth of the enamel: they are not of one tooth, or
/// not in one frame. `overlap_share`: of the enamel's leaves, those that lie in the dentin's surface, too.
void require_layers_that_fit(const LayersApart& apart, double overlap_share, const std::string& where);

}  // namespace cavum
