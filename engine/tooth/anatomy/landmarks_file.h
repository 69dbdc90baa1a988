// Landmarks as JSON text, to the last bit: an exam keeps those that its zones were laid by, so that
// a program which finds them better one day still marks and replays it by the ground the candidate
// stood on.
#pragma once

#include <string>
#include <string_view>

#include "engine/tooth/anatomy/landmarks.h"

namespace cavum {

/// One line of JSON; the keys are the names in `Landmarks`. Notes for people are left out, and so
/// are the class's reason and probability.
[[nodiscard]] std::string landmarks_text(const Landmarks& landmarks);

/// What landmarks_text wrote. Throws Error at `where` when it is anything else: no JSON, a key too
/// few or of another kind, a number that is none or beyond 1 m, a list of more than 20,000 points.
[[nodiscard]] Landmarks parse_landmarks(std::string_view text, const std::string& where);

}  // namespace cavum
