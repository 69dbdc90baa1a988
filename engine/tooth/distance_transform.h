// Exact Euclidean distance transform of a lattice: the nearest marked cell of every cell. Whole
// numbers throughout, so it is the same on every machine. Source: Felzenszwalb and Huttenlocher,
// Theory of Computing 8 (2012) 415: lower envelopes of parabolas, one axis after the other.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/base/vec.h"

namespace cavum {

/// For every cell of a dense lattice (x fastest, at most 16,384 cells along each axis) the index of
/// the nearest cell with `seed[i] != 0`; of equally near ones the lowest index; -1 where none lies
/// within `radius_cells`. Its time grows with the number of cells, whatever the seeds.
[[nodiscard]] std::vector<std::int32_t> nearest_seed(
    IVec3 size, std::span<const std::uint8_t> seed,
    double radius_cells = std::numeric_limits<double>::infinity());

}  // namespace cavum
