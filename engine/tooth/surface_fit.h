// What a leaf's distance should be, judged by the distances around it: near the surface they lie on
// a plane, nearly. Two planes are fitted, one that trusts the nearest leaves most and one that
// takes all about alike; how far they differ tells of a bend. Makes the tooth file small (see
// packed_octree.h); has no part in the physics.
#pragma once

#include <array>
#include <cstdint>

namespace cavum {

/// A leaf as the fit sees it.
struct FitLeaf {
  static constexpr std::uint8_t k_max_error = 40, k_guess = 254, k_unused = 255;
  std::int8_t code = 0;           ///< distance code (see encode_distance)
  std::uint8_t error = k_unused;  ///< by how much the fit was wrong here, 0..k_max_error; or: only
                                  ///< a guess so far; or: of no use
};

/// 4x4x4 leaves and the two around them, x fastest.
struct FitWindow {
  static constexpr int k_edge = 8, k_margin = 2;
  std::array<FitLeaf, std::size_t{k_edge} * k_edge * k_edge> leaf;
  [[nodiscard]] static constexpr int index(int x, int y, int z) noexcept {
    return (x + k_margin) + k_edge * (y + k_margin) + k_edge * k_edge * (z + k_margin);
  }
};

struct SurfaceFit {
  double near = 0.0, wide = 0.0;  ///< codes expected by the two planes; any finite number, 0
                                  ///< without any leaf to judge by
  int error_8 =
      -1;  ///< mean error of the known leaves around in 1/8 codes, 0..320; -1 when none is known
};

/// Expectation at `window.leaf[index]` from the known and guessed leaves up to sqrt(5) leaves away.
/// IEEE double + - * / on whole numbers in a fixed order, so every build gets the same bits (as the
/// physics does).
[[nodiscard]] SurfaceFit fit_surface(const FitWindow& window, int index) noexcept;

}  // namespace cavum
