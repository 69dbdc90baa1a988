// Exact Euclidean distance transform with the nearest feature (Felzenszwalb and Huttenlocher, lower
// envelopes of parabolas, one axis after the other). Whole numbers throughout: the same on every machine.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/vec.h"

namespace cavum {

/// For every cell of a dense grid (x fastest) the index of the nearest cell with `seed[i] != 0`; -1 when
/// there is no seed at all. Of equally near seeds one is chosen by a fixed rule.
[[nodiscard]] std::vector<std::int32_t> nearest_seed(IVec3 size, const std::vector<std::uint8_t>& seed);

}  // namespace cavum
