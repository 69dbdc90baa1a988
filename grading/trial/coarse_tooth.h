// The same tooth in leaves twice as wide: an eighth of the work, for a first look at what is far
// from every limit.
#pragma once

#include "engine/tooth/tooth.h"

namespace cavum::grading {

/// Solid where the mean distance of its eight leaves says so; the tissue is the most frequent of
/// that kind among them. Distances hold to a leaf.
[[nodiscard]] Tooth coarse_tooth(const Tooth& tooth);

}  // namespace cavum::grading
