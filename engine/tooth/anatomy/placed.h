// Landmarks by name, and those that a person put in place of what was found.
#pragma once

#include <vector>

#include "engine/tooth/anatomy/landmarks.h"

namespace cavum {

/// Puts each point where its name says. The central fissure ends at its pits, a ridge's crest its
/// lowest place. A list (`cusp_3`) grows by one at most; what is beyond that, or has an unknown
/// name, is left out with a note.
void place_landmarks(const std::vector<NamedPoint>& placed, Landmarks& landmarks);

}  // namespace cavum
