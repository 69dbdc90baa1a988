// Gum around the necks of a tooth and its neighbours, with a papilla below each contact. A body of
// its own: a leaf of air lies between it and every tooth, so that no tooth's surface is changed
// (and none is attached to it).
#pragma once

#include <string>
#include <vector>

#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum {

/// Numbers of the tissues beside a tooth; air: there is none of it.
struct AdjacentIds {
  std::uint8_t enamel = k_air, dentin = k_air, gum = k_air;
};

// The shape, mm. Sources and what is our choice: docs/neighbour.md.
inline constexpr double k_gum_margin_mm = 1.0;  ///< of the margin over the cemento-enamel junction
inline constexpr double k_gum_thickness_mm = 1.2;  ///< of the gum, away from its margin
inline constexpr double k_gum_edge_mm = 0.35;      ///< of its margin
inline constexpr double k_papilla_below_contact_mm =
    1.2;  ///< tip of the papilla below the middle of the contact area
inline constexpr double k_papilla_wide_mm =
    2.2;  ///< teeth further apart than this have no papilla between them
inline constexpr double k_gum_below_neck_mm = 1.2;  ///< where it is cut off
inline constexpr double k_gum_room_mm = 0.8;        ///< that a lattice needs around the tooth's own

/// Turns air to gum; `contacts` are the middles of the contact areas. Throws Error (`where` names
/// the asker) when the tooth has no neck.
void add_gum(TissueGrid& grid, const std::vector<Tissue>& tissues, const AdjacentIds& ids,
             const Landmarks& landmarks, const std::vector<Vec3>& contacts,
             const std::string& where);

}  // namespace cavum
