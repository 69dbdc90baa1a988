// Are enamel, dentin and pulp what the user says they are, and of one tooth? Told from a lattice of
// leaves, so that meshes and label maps are judged by the same rules: what the pulp touches and
// where it ends, voids between enamel and dentin, pieces that hang on nothing, dentin that lies
// bare.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/vec.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum {

/// Faces between a pulp cell and its six neighbours, by the neighbour's tissue. Faces on the
/// lattice's border do not count.
[[nodiscard]] std::array<std::uint64_t, 256> pulp_faces(IVec3 size,
                                                        const std::vector<std::uint8_t>& tissue);

/// Throws Error when the pulp lies in the enamel: more of its faces are on enamel than on dentin,
/// and no fewer than on air.
void require_layer_order(const std::array<std::uint64_t, 256>& faces, const std::string& where,
                         const Message& what_to_do);

/// How enamel and dentin lie upon each other.
struct LayersApart {
  double facing = 0.0;  ///< places where one faces the other along an axis, by runs of enamel along
                        ///< the axes: most of them end on dentin
  double share = 0.0;   ///< of these places those with a void between them, 0 to 1
  double usual_mm =
      0.0;  ///< the median of those voids along the axis, which may cut them slantwise
};
/// Of a lattice before gaps are closed. Voids of more than 0.15 mm (and two leaves) up to 3 mm
/// count.
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

/// Shares of leaves that lie in the dentin, too, 0 to 1.
struct Overlaps {
  std::uint64_t leaves = 0;  ///< in more than one surface
  double of_the_enamel = 0.0, of_the_pulp = 0.0;
  double chamber =
      0.0;  ///< what the dentin's surface leaves empty within itself, over the pulp's volume
};

/// How far the pulp hangs out of the lowest dentin, mm; negative: it ends above. Of a lattice whose
/// +z is occlusal.
[[nodiscard]] double pulp_below_dentin_mm(const TissueGrid& grid);
/// Throws Error when that is more than half a millimetre: an open apex is right, a pulp that hangs
/// out of it is another tooth's.
void require_pulp_in_root(double below_mm, const std::string& where);

/// Throws Error when dentin and enamel do not meet, stand apart, or one lies in the other by more
/// than a tenth of the enamel; and when the dentin has a chamber and more than a tenth of the pulp
/// lies in the dentin, or it has none and less than eight tenths do: they are not of one tooth, or
/// not in one frame.
void require_layers_that_fit(const LayersApart& apart, const Overlaps& overlaps,
                             const std::string& where);

/// Enamel that does not hang together with the crown's.
struct EnamelPieces {
  double floating_mm3 = 0.0;  ///< of pieces that touch no dentin either
  Vec3 floating_mm;           ///< middle of the largest of them
  double apart_mm3 = 0.0;     ///< of pieces on dentin: a pearl, or a crown that is worn through
  Vec3 apart_mm;
};
/// Pieces of less than 0.02 mm³ do not count.
[[nodiscard]] EnamelPieces enamel_pieces(const TissueGrid& grid);
/// Throws Error when a piece floats.
void require_no_floating_enamel(const EnamelPieces& pieces, const std::string& where);

}  // namespace cavum
