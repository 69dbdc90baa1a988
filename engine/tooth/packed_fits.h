// What is known of the octree that another is coded like: its bricks, and what each leaf's distance
// was expected to be.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/tooth/brick_lattice.h"
#include "engine/tooth/leaf_layers.h"
#include "engine/tooth/octree.h"

namespace cavum {

struct PackedFits {
  static constexpr std::uint32_t k_no_full = ~0u;
  struct Brick {
    IVec3 at;            // in the lattice
    std::uint32_t full;  // its number among the full ones, or k_no_full
  };
  /// What a leaf's distance is expected to be, and in which context the residual is coded.
  struct Expected {
    std::uint16_t context = 0;
    std::int8_t code = 0;
  };

  std::array<bool, 256> solid;
  BrickLattice lattice;
  std::vector<Brick> brick;
  Bytes tissue, distance;          // of the leaves of all bricks, and of the full ones
  std::vector<Expected> expected;  // of the latter
  std::vector<LeafLayers> layers;  // of the full bricks

  /// The number of the full brick at a place; k_no_full when there is none.
  [[nodiscard]] std::uint32_t full_at(IVec3 at) const noexcept {
    const std::uint32_t what = lattice[at];
    return what < BrickLattice::k_first_brick ? k_no_full
                                              : brick[what - BrickLattice::k_first_brick].full;
  }
};

/// Where an octree differs from one whose fits are known, or where what is known about it would
/// come out differently. All other fits are taken over: the bricks of both are coded in the same
/// order, so what lies around a brick is at that moment what it was then.
class Differences {
 public:
  Differences(const PackedFits& like, const BrickLattice& lattice,
              const std::vector<PackedFits::Brick>& brick, const Bytes& tissue)
      : lattice_(lattice), near_(lattice.cells(), 0) {
    constexpr int k_label_reach =
        2;  // a label changes the layers of the bricks beside it, and these what is guessed there
    const int n = lattice.bricks_along();
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
          if (differ(like, lattice[{x, y, z}], like.lattice[{x, y, z}], brick, tissue))
            note({x, y, z}, k_label_reach);
  }
  /// Something differs at `at`: bricks up to `reach` away are worked out anew.
  void note(IVec3 at, int reach) noexcept {
    const int last = lattice_.bricks_along() - 1;
    const auto low = [&](int v) { return std::max(v - reach, 0); };
    const auto high = [&](int v) { return std::min(v + reach, last); };
    for (int z = low(at.z); z <= high(at.z); ++z)
      for (int y = low(at.y); y <= high(at.y); ++y)
        for (int x = low(at.x); x <= high(at.x); ++x) near_[lattice_.place({x, y, z})] = 1;
  }
  [[nodiscard]] bool near(IVec3 at) const noexcept { return near_[lattice_.place(at)] != 0; }

 private:
  static bool differ(const PackedFits& like, std::uint32_t is, std::uint32_t was,
                     const std::vector<PackedFits::Brick>& brick, const Bytes& tissue) noexcept {
    if (is < BrickLattice::k_first_brick || was < BrickLattice::k_first_brick) return is != was;
    const std::size_t i = is - BrickLattice::k_first_brick, w = was - BrickLattice::k_first_brick;
    if ((brick[i].full == PackedFits::k_no_full) != (like.brick[w].full == PackedFits::k_no_full))
      return true;
    return !std::equal(&tissue[i * Octree::k_brick_leaves],
                       &tissue[i * Octree::k_brick_leaves] + Octree::k_brick_leaves,
                       &like.tissue[w * Octree::k_brick_leaves]);
  }
  const BrickLattice& lattice_;
  std::vector<std::uint8_t> near_;
};

}  // namespace cavum
