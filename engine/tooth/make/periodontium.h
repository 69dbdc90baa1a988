// The tissue around the roots, so that a perforation of the furcation or of a root wall meets a
// tissue, as a perforation of the pulp does. It is not solid (k = 0): the bur enters it without
// resistance.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/tooth/tissue_grid.h"

namespace cavum {

/// Adds periodontium (id k_periodontium): every air leaf within `thickness_mm` (> 0; ~1 mm holds
/// the ligament, 0.15-0.4 mm, and the bone's first layer) of the solid surface whose nearest solid
/// leaf is dentin and that lies below the enamel's centroid (z), and no more than 1 mm above the
/// lowest enamel of its direction: a cleft in a crown holds none. Other leaves keep their labels,
/// all leaves their distances. The grid grows where the layer would not fit. Returns how many
/// leaves were added; 0 when there is no dentin or `thickness_mm` is 0. Throws Error when
/// `thickness_mm` is negative, not a number or above 5.
std::uint64_t add_periodontium(TissueGrid& grid, double thickness_mm);

}  // namespace cavum
