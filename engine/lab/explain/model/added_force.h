// What a loaded force model adds to the Voigt law on a recorded motion, to be taken off before more
// is looked for.
#pragma once

#include "engine/lab/explain/model/view.h"
#include "engine/physics/force/force_model.h"

namespace cavum::explain {

/// Force that force terms add to the Voigt law of `tissue` on the motion of `scene`, N, shape
/// [rows]: the engine's own terms, row by row, each session from the start. Without a column
/// spindle_rpm the tool is taken to turn; without `wet` the spray runs while it turns; without
/// `approach_deg` it comes from above; without removed_mm3 the bur is new.
[[nodiscard]] Series terms_force_n(const ForceTerms& terms, Viscoelastic tissue,
                                   const Scene& scene);

/// Force that the terms and measurement effects of `model` add to its Voigt law on the recorded
/// motion, N, shape [rows]. k and c are those of `material`. Where position or speed is uncertain
/// it is the mean over what they may have been, as when `explain` found it. A measurement effect of
/// the kind of a term (phases of each session) counts instead of it when it fits the recording.
/// Throws Error(where, ...) on an unknown material or measurement effect, or one these data lack a
/// column for.
[[nodiscard]] Series added_force_n(const ForceModel& model, const std::string& material,
                                   const Recording& recording, const std::string& where);

}  // namespace cavum::explain
