// A tooth without its cavities: what a void tissue (pulp, periodontium) takes up is given to the
// solid tissue beside it.
#pragma once

#include <array>

#include "engine/tooth/tooth.h"

namespace cavum {

/// `tissues`: by id, those that are filled. Each of their leaves becomes what the nearest solid
/// leaf is, in steps from leaf to leaf; one that no solid tissue can be reached from stays.
/// Distances further than three leaves from what was filled keep every bit, so that a motion which
/// does not come as near gives the same forces.
[[nodiscard]] Tooth filled_tooth(const Tooth& tooth, const std::array<bool, 256>& tissues);

}  // namespace cavum
