// Random mixtures of too little and too much: pillars left standing in the target, and bites out of
// what lies around. All drawn by a fixed seed.
#pragma once

#include <vector>

#include "grading/trial/faulty_preparations.h"

namespace cavum::grading {

/// In turn: at least a quarter of the target left; a third of its volume removed beyond it; both by
/// half of that and more. None where a target's surroundings do not hold so much.
[[nodiscard]] std::vector<FaultyPreparation> random_preparations(const Task& task,
                                                                 const TargetField& field);

}  // namespace cavum::grading
