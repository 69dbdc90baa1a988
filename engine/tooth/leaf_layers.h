// How far the leaves of a brick are from the nearest leaf of the other kind, solid or not, as far
// as labels tell. Helps to pack an octree (packed_octree.h): the leaves next to the surface come
// first.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cavum {

/// A bit for each leaf of a window (8x8x8, see FitWindow): bit x + 8 y of number z.
using WindowBits = std::array<std::uint64_t, 8>;

inline constexpr std::size_t k_leaf_layers = 7;
/// A bit for each of a brick's 64 leaves (x fastest): number n holds those whose nearest leaf of
/// the other kind is sqrt(n + 1) leaves away, the last one all others. Each leaf is in one of them.
using LeafLayers = std::array<std::uint64_t, k_leaf_layers>;
[[nodiscard]] LeafLayers leaf_layers(const WindowBits& solid) noexcept;

}  // namespace cavum
