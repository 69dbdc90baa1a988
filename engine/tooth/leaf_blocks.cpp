#include "engine/tooth/leaf_blocks.h"

#include <algorithm>
#include <cstring>

#include "engine/base/error.h"

namespace cavum {
namespace {

constexpr int k_brick = Octree::k_brick_edge, k_bricks = LeafBlocks::k_edge / k_brick;

int blocks_of(int leaves) { return (leaves + LeafBlocks::k_edge - 1) / LeafBlocks::k_edge; }

/// Place of the row of four leaves (y, z) of a brick in its block.
std::size_t row_of(IVec3 brick, int y, int z) {
  return (static_cast<std::size_t>(brick.z * k_brick + z) * LeafBlocks::k_edge +
          static_cast<std::size_t>(brick.y * k_brick + y)) *
             LeafBlocks::k_edge +
         static_cast<std::size_t>(brick.x * k_brick);
}

}  // namespace

LeafBlocks::LeafBlocks(const Octree& tooth)
    : leaf_mm_(tooth.leaf_mm()),
      origin_mm_(tooth.origin_mm()),
      size_(tooth.size()),
      blocks_{blocks_of(size_.x), blocks_of(size_.y), blocks_of(size_.z)},
      all_(cells_of(blocks_)) {
  LeafBounds box{};
  for (int z = 0; z < blocks_.z; ++z)
    for (int y = 0; y < blocks_.y; ++y)
      for (int x = 0; x < blocks_.x; ++x) {
        Block& block = all_[index({x, y, z})];
        block.last_edit = tooth.last_edit({x, y, z});
        take_block(tooth, {x, y, z}, block, box);
      }
}

void LeafBlocks::take(const Octree& now, std::vector<LeafBounds>& changed) {
  if (!(now.size() == size_) || now.leaf_mm() != leaf_mm_ || !(now.origin_mm() == origin_mm_))
    throw Error(msg("tooth copy"), msg("the octree is of another tooth"),
                msg("make a new copy for each tooth"));
  LeafBounds box{};
  for (int z = 0; z < blocks_.z; ++z)
    for (int y = 0; y < blocks_.y; ++y)
      for (int x = 0; x < blocks_.x; ++x) {
        Block& block = all_[index({x, y, z})];
        const auto edit = now.last_edit({x, y, z});
        if (edit == block.last_edit) continue;
        block.last_edit = edit;
        if (take_block(now, {x, y, z}, block, box)) changed.push_back(box);
      }
}

bool LeafBlocks::take_block(const Octree& now, IVec3 at, Block& block, LeafBounds& box) {
  box = {};
  for (int z = 0; z < k_bricks; ++z)
    for (int y = 0; y < k_bricks; ++y)
      for (int x = 0; x < k_bricks; ++x) {
        const IVec3 brick{x, y, z};
        const Octree::FullBrick fresh =
            now.brick({at.x * k_bricks + x, at.y * k_bricks + y, at.z * k_bricks + z});
        if (!block.leaves) {
          const bool same = std::all_of(fresh.tissue.begin(), fresh.tissue.end(),
                                        [&](int t) { return t == block.tissue; }) &&
                            std::all_of(fresh.distance.begin(), fresh.distance.end(),
                                        [&](int d) { return d == block.code; });
          if (same) continue;
          block.leaves = std::make_unique<Leaves>();
          block.leaves->tissue.fill(block.tissue);
          block.leaves->code.fill(block.code);
        }
        for (int j = 0; j < k_brick; ++j)
          for (int i = 0; i < k_brick; ++i) {
            const std::size_t from = static_cast<std::size_t>(4 * i + 16 * j),
                              to = row_of(brick, i, j);
            std::uint8_t* const tissue = block.leaves->tissue.data() + to;
            std::int8_t* const code = block.leaves->code.data() + to;
            if (std::memcmp(tissue, fresh.tissue.data() + from, 4) == 0 &&
                std::memcmp(code, fresh.distance.data() + from, 4) == 0)
              continue;
            for (int k = 0; k < k_brick; ++k) {
              const std::size_t leaf = from + static_cast<std::size_t>(k);
              if (tissue[k] == fresh.tissue[leaf] && code[k] == fresh.distance[leaf]) continue;
              tissue[k] = fresh.tissue[leaf];
              code[k] = fresh.distance[leaf];
              box.add(IVec3{x * k_brick + k, y * k_brick + i, z * k_brick + j});
            }
          }
      }
  if (box.empty()) return false;
  const auto& l = *block.leaves;
  const bool uniform =
      std::all_of(l.tissue.begin(), l.tissue.end(), [&](int t) { return t == l.tissue[0]; }) &&
      std::all_of(l.code.begin(), l.code.end(), [&](int d) { return d == l.code[0]; });
  if (uniform) {
    block.tissue = l.tissue[0];
    block.code = l.code[0];
    block.leaves.reset();
  }
  const IVec3 first{at.x * k_edge, at.y * k_edge, at.z * k_edge};
  box = {first + box.low, first + box.high};
  return true;
}

void LeafBlocks::copy_cube(IVec3 low, int edge, std::uint8_t* tissue,
                           std::int8_t* code) const noexcept {
  const auto block_at = [](int leaf) {
    return leaf >= 0 ? leaf / k_edge : (leaf - k_edge + 1) / k_edge;
  };
  for (int z = 0; z < edge; ++z)
    for (int y = 0; y < edge; ++y)
      for (int x = 0; x < edge;) {
        const IVec3 leaf = low + IVec3{x, y, z},
                    at{block_at(leaf.x), block_at(leaf.y), block_at(leaf.z)};
        const int inner = leaf.x - at.x * k_edge, n = std::min(k_edge - inner, edge - x);
        const auto to = static_cast<std::size_t>((z * edge + y) * edge + x),
                   count = static_cast<std::size_t>(n);
        const bool outside = !lies_in(at, blocks_);
        const Block* const block = outside ? nullptr : &all_[index(at)];
        if (block == nullptr || !block->leaves) {
          std::memset(tissue + to, block == nullptr ? int{k_air} : block->tissue, count);
          std::memset(code + to, block == nullptr ? k_distance_far : block->code, count);
        } else {
          const auto from = static_cast<std::size_t>(
              ((leaf.z - at.z * k_edge) * k_edge + leaf.y - at.y * k_edge) * k_edge + inner);
          std::memcpy(tissue + to, block->leaves->tissue.data() + from, count);
          std::memcpy(code + to, block->leaves->code.data() + from, count);
        }
        x += n;
      }
}

}  // namespace cavum
