// Sets teeth beside a tooth, in its own octree: the nearest part of a crown on the mesial or distal
// side, turned and shifted until the surfaces touch at the height of contour, and gum around the
// necks. Tissues: `neighbour_enamel`, `neighbour_dentin`, `gingiva`.
#pragma once

#include <optional>
#include <string>

#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/tooth.h"

namespace cavum {

/// A tooth to stand on one side.
struct AdjacentTooth {
  const Tooth* tooth = nullptr;  ///< in its own tooth frame; null: none
  double turn_deg = 0.0;         ///< about z, from mesial towards buccal: teeth stand in an arch
};

struct AdjacentSpec {
  AdjacentTooth mesial, distal;
  double contact_mm = 0.0;  ///< distance at the contact, 0 to k_widest_contact_leaves leaves
  double reach_mm = 3.0;    ///< how far the neighbour is kept beyond the contact, 1 to 6
  bool gum = false;
  bool confirmed =
      false;  ///< they are to stand side by side although no jaw has them so (in_a_row.h)
};
inline constexpr double k_widest_contact_leaves = 1.5;

/// How two surfaces meet.
struct ContactFacts {
  Vec3 at_mm;           ///< middle of the tooth's surface that lies within 0.05 mm of the neighbour
  double gap_mm = 0.0;  ///< least distance
  double width_mm = 0.0, height_mm = 0.0;  ///< of that area, buccolingual and up
};

struct AddedAdjacent {
  Tooth tooth;
  std::optional<ContactFacts> mesial, distal;
  double neighbour_mm3 = 0.0, gum_mm3 = 0.0;
};

/// Contact areas are laid on each other in height and width (those of
/// `Landmarks::height_of_contour_mm`; where a body has none, the axes of both frames are), then the
/// neighbour is moved along x until the least distance is `contact_mm`. That distance is taken from
/// places on the tooth's surface to the neighbour's interpolated distance: good to a tenth of a
/// leaf. The tooth's own leaves stay as they are. The neighbour's pulp is dentin here, its roots
/// are cut off 5 mm below the contact. Throws Error (`where` names the asker) when a tooth is given
/// that has neighbours already, the leaves differ, the lattice grows too large, the surfaces do not
/// meet, a length is out of range, or gum is asked for around a tooth without a neck, or teeth that
/// are no neighbours are not confirmed. What was confirmed or could not be checked is a warning in
/// the tooth's notes.
[[nodiscard]] AddedAdjacent add_adjacent(const Tooth& tooth, const AdjacentSpec& spec,
                                         const std::string& where);

}  // namespace cavum
