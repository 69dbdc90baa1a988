// A copy of a tooth's leaves for those who draw it: blocks of 16x16x16 leaves, each taken anew only
// when it was edited. Taking is short (some 50 microseconds after a carve) and is all that needs
// the octree; what is drawn is made from the copy afterwards.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/tooth/octree.h"

namespace cavum {

/// Belongs to one thread. The octree must stand still while it is taken from (a lock of its owner,
/// or a snapshot), and is not kept.
class LeafBlocks {
 public:
  static constexpr int k_edge = Octree::k_mark_edge;  ///< of a block, leaves

  explicit LeafBlocks(const Octree& tooth);
  /// Takes over what differs in `now`, the same tooth at another moment of the same exam, earlier
  /// or later. Appends to `changed` a box for each block in which any leaf's tissue or distance
  /// differs.
  void take(const Octree& now, std::vector<LeafBounds>& changed);

  [[nodiscard]] double leaf_mm() const noexcept { return leaf_mm_; }
  [[nodiscard]] Vec3 origin_mm() const noexcept { return origin_mm_; }
  [[nodiscard]] IVec3 size() const noexcept { return size_; }  ///< leaves
  /// Copies the leaves of a cube of `edge` leaves from `low`, x fastest: tissues and distance
  /// codes; air beyond the tooth.
  void copy_cube(IVec3 low, int edge, std::uint8_t* tissue, std::int8_t* code) const noexcept;

 private:
  static constexpr std::size_t k_leaves = static_cast<std::size_t>(k_edge) * k_edge * k_edge;
  struct Leaves {
    std::array<std::uint8_t, k_leaves> tissue;
    std::array<std::int8_t, k_leaves> code;
  };
  /// All leaves alike, or `leaves`.
  struct Block {
    std::uint64_t last_edit = 0;
    std::uint8_t tissue = k_air;
    std::int8_t code = k_distance_far;
    std::unique_ptr<Leaves> leaves;
  };
  [[nodiscard]] std::size_t index(IVec3 block) const noexcept { return cell_index(block, blocks_); }
  /// Returns whether anything differed; then `box` holds it.
  static bool take_block(const Octree& now, IVec3 at, Block& block, LeafBounds& box);

  double leaf_mm_;
  Vec3 origin_mm_;
  IVec3 size_, blocks_;
  std::vector<Block> all_;
};

}  // namespace cavum
