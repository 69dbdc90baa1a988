// The bricks of an octree as a lattice, with one of air around it, and windows on the leaves of a
// brick and those near it. Helps to pack an octree (packed_octree.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/base/vec.h"
#include "engine/tooth/surface_fit.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum {

/// Places in a window: how much farther a leaf lies that is x, y, z away.
[[nodiscard]] constexpr int window_step(int x, int y, int z) noexcept {
  return x + FitWindow::k_edge * (y + FitWindow::k_edge * z);
}

/// What each brick of the lattice is: all of one tissue, 0..255, not known yet, or a brick by its
/// number.
class BrickLattice {
 public:
  static constexpr std::uint32_t k_unknown = 256, k_first_brick = 257;
  /// 2^levels bricks along each edge, none of them known.
  explicit BrickLattice(int levels)
      : edge_((1 << levels) + 2), cell_(static_cast<std::size_t>(edge_) * edge_ * edge_, k_air) {
    fill({0, 0, 0}, levels, k_unknown);
  }
  [[nodiscard]] std::uint32_t operator[](IVec3 brick) const noexcept { return cell_[index(brick)]; }
  [[nodiscard]] int bricks_along() const noexcept { return edge_ - 2; }
  /// Of a brick in an array of `cells()`, the air around included.
  [[nodiscard]] std::size_t place(IVec3 brick) const noexcept { return index(brick); }
  [[nodiscard]] std::size_t cells() const noexcept { return cell_.size(); }
  void fill(IVec3 low, int level, std::uint32_t what) noexcept {
    const int n = 1 << level;
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y) {
        const auto row = cell_.begin() + static_cast<std::ptrdiff_t>(index(low + IVec3{0, y, z}));
        std::fill(row, row + n, what);
      }
  }

  /// Fills `window` (see FitWindow) with the 64 leaves of a brick and those around. `of(what)`
  /// points to a brick's 64 leaves, or nowhere; then `other(what)` is all of it.
  template <class Value, std::size_t N, class Of, class Other>
  void gather(IVec3 brick, std::array<Value, N>& window, const Of& of, const Other& other) const {
    constexpr std::array<int, 3> k_begin{
        0, FitWindow::k_margin,
        FitWindow::k_margin + 4};  // in the window, of the lower, the own and the upper brick
    for (int z = 0; z < 3; ++z)
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) {
          const std::uint32_t what = (*this)[brick + IVec3{x - 1, y - 1, z - 1}];
          const auto* const leaves = of(what);
          const Value all = leaves == nullptr ? other(what) : Value{};
          const int from_y = y == 0 ? 2 : 0, from_z = z == 0 ? 2 : 0, rows_y = y == 1 ? 4 : 2,
                    rows_z = z == 1 ? 4 : 2;
          Value* const to = window.data() + window_step(k_begin[static_cast<std::size_t>(x)],
                                                        k_begin[static_cast<std::size_t>(y)],
                                                        k_begin[static_cast<std::size_t>(z)]);
          for (int k = 0; k < rows_z; ++k)
            for (int j = 0; j < rows_y; ++j) {
              Value* const row = to + window_step(0, j, k);
              const int first = (from_y + j) * 4 + (from_z + k) * 16;
              if (leaves == nullptr)
                std::fill_n(row, x == 1 ? 4 : 2, all);
              else if (x == 1)
                std::copy_n(leaves + first, 4, row);
              else
                std::copy_n(leaves + first + (x == 0 ? 2 : 0), 2, row);
            }
        }
  }

 private:
  [[nodiscard]] std::size_t index(IVec3 b) const noexcept {
    return (static_cast<std::size_t>(b.z + 1) * static_cast<std::size_t>(edge_) +
            static_cast<std::size_t>(b.y + 1)) *
               static_cast<std::size_t>(edge_) +
           static_cast<std::size_t>(b.x + 1);
  }
  int edge_;  // bricks along an edge, with one of air around
  std::vector<std::uint32_t> cell_;
};

}  // namespace cavum
