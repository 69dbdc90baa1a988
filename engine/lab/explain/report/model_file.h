// What was found, as a force model: a TOML file that exam and rigs load, and `explain --model`
// takes off the measured force before it looks for more (added_force.h).
#pragma once

#include "engine/lab/explain/inference/explain.h"
#include "engine/lab/explain/model/added_force.h"
#include "engine/physics/force/force_model.h"

namespace cavum::explain {

/// `start` with k and c of all tissues that resist replaced by the fitted ones, and the causes
/// added: those that act in a live exam as [[terms]], the others as [[measurement]]; terms of
/// `start` are kept. Text of the file. Throws Error beyond k_max_terms.
[[nodiscard]] std::string extended_model_toml(const Explanation& explanation,
                                              const ForceModel& start);

/// "dentin" when the model has it, else the first tissue that resists.
[[nodiscard]] std::string material_of(const ForceModel& model);

}  // namespace cavum::explain
