// What was found, as a force model: a TOML file that exam and rigs load, and `explain --model` takes off the measured force
// before it looks for more.
#pragma once

#include "engine/explain/explain.h"
#include "engine/force/force_model.h"

namespace cavum::explain {

/// `start` with k and c of all tissues that resist replaced by the fitted ones, and the causes added: those that act in a live
/// exam as [[terms]], the others as [[measurement]]. Text of the file.
[[nodiscard]] std::string extended_model_toml(const Explanation& explanation, const ForceModel& start);

/// Force that force terms add to the Voigt law of `tissue` on the motion of `scene`, N, shape [rows]: the engine's own terms, row by row, each
/// session from the start. Without a column spindle_rpm the tool is taken to turn; without `wet` the spray runs while it turns; without
/// `approach_deg` it comes from above; without removed_mm3 the point is new.
[[nodiscard]] Series terms_force_n(const ForceTerms& terms, Viscoelastic tissue, const Scene& scene);

/// Force that the terms and measurement effects of `model` add to its Voigt law on the recorded motion, N, shape [rows]. k and c
/// are those of `material`. Throws Error(where, ...) on an unknown material or measurement effect, or one these data lack a column for.
[[nodiscard]] Series added_force_n(const ForceModel& model, const std::string& material, const Recording& recording, const std::string& where);

/// "dentin" when the model has it, else the first tissue that resists.
[[nodiscard]] std::string material_of(const ForceModel& model);

}  // namespace cavum::explain
