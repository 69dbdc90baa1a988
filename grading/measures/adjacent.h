// What the work did to the teeth and the gum beside the tooth: a nick's depth and area, the
// clearance at the contact, gum cut and for how long.
#pragma once

#include "grading/measures/grade_input.h"

namespace cavum::grading {

/// A shell of enamel between the cavity and the neighbour no thicker than this does not count as
/// left: an operator keeps it while cutting and breaks it out with a hand instrument, which there
/// is none of here.
inline constexpr double k_shell_mm = 0.5;
/// Gum is touched in tenths of a second.
inline constexpr std::int64_t k_gum_window_ticks = 100;

/// Needs `input.beside`.
///
/// *Nick*: hard tissue of a neighbour that was removed. Its depth is the largest distance of the
/// cut's floor from the neighbour's surface as it was; its area that of this surface which is gone,
/// leaf² |n| a face, n the surface's normal and the face's axis. Bounds: a leaf (half for each
/// surface); half a leaf along the rim.
///
/// *Clearance*: the least distance from what is left of the tooth to the neighbour's surface as it
/// was. It is looked for in the rows along x whose proximal surface has the neighbour's within 1 mm
/// before it: in those where the target reaches within k_shell_mm of that surface (the part of the
/// contact that the target opens), and in those beside a row that was opened (the cavity's margin).
/// In each the outermost leaf left counts, a shell with cavity behind it does not. So a contact
/// that still stands has the contact's own distance. Bound: a leaf. None where the target opens no
/// such row.
///
/// *Gum*: leaves of it removed, whole; tenths of a second in which some of it went, with the
/// handpiece turning of itself. Bound: a tenth for each stretch.
///
/// `volumes` gets what was removed by tissue, and of that what the scenario protects.
[[nodiscard]] AdjacentMeasures measure_adjacent(const GradeInput& input, std::int64_t last_tick,
                                                VolumeMeasures& volumes);

}  // namespace cavum::grading
