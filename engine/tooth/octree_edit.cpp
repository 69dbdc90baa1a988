#include <algorithm>
#include <bit>

#include "engine/base/hash.h"
#include "engine/tooth/octree.h"

namespace cavum {

bool Octree::any_of(EightCodes marks) noexcept {
  using Halves = std::uint64_t __attribute__((vector_size(16)));
  const auto halves = std::bit_cast<Halves>(marks);
  return (halves[0] | halves[1]) != 0;
}

bool Octree::cut_block(FullBrick& brick, int block, EightCodes cut, EightCodes inside,
                       std::int16_t solid_most) const noexcept {
  using Labels = std::uint8_t __attribute__((vector_size(8)));
  using Codes8 = std::int8_t __attribute__((vector_size(8)));
  const std::uint64_t tissues = bytes_of_block(brick.tissue.data(), block),
                      codes = bytes_of_block(brick.distance.data(), block);
  const auto label = __builtin_convertvector(std::bit_cast<Labels>(tissues), EightCodes);
  const auto before = __builtin_convertvector(std::bit_cast<Codes8>(codes), EightCodes);
  const EightCodes full = label != std::int16_t{k_air};
  const auto first = static_cast<std::uint8_t>(
      tissues >> (std::countr_zero(tissues | 1ULL << 63) & ~7));  // that is not air
  EightCodes solid = solid_[first] ? full : EightCodes{};
  if (any_of(label != (full & first)))  // more than one tissue
    for (int i = 0; i < 8; ++i) solid[i] = solid_[tissues >> 8 * i & 255] ? -1 : 0;
  const EightCodes removed = inside & full;
  // A solid leaf stays inside the surface, or outside it by no more than the clearance: cut on both
  // sides of a tool whose width is a whole number of leaves, such leaves would hold it. Air lies
  // outside.
  const EightCodes of_solid = cut < solid_most ? cut : EightCodes{} + solid_most;
  const EightCodes least = removed & 1, of_others = removed != 0 && cut < least ? least : cut;
  const EightCodes code = (solid & ~inside) != 0 ? of_solid : of_others;
  const EightCodes after = code > before ? code : before;
  if (!any_of(removed | (after != before))) return false;
  put_bytes_of_block(
      brick.tissue.data(), block,
      std::bit_cast<std::uint64_t>(__builtin_convertvector(label & ~inside, Labels)));
  put_bytes_of_block(brick.distance.data(), block,
                     std::bit_cast<std::uint64_t>(__builtin_convertvector(after, Codes8)));
  return true;
}

bool Octree::apply(Plan& plan, std::vector<RemovedLeaf>& removed) noexcept {
  plan.applied_ = 0;
  plan.out_of_room_ = false;
  if (!plan.bricks_.empty()) apply_in(root_, levels_, {0, 0, 0}, 0, plan, removed);
  plan.bricks_.clear();
  return !plan.out_of_room_;
}

void Octree::apply_in(std::uint32_t& ref, int level, IVec3 low, std::uint32_t place, Plan& plan,
                      std::vector<RemovedLeaf>& removed) noexcept {
  if (level == 0) {
    if (bricks_.full() || labels_.full() || removed.capacity() - removed.size() < k_brick_leaves) {
      plan.out_of_room_ = true;
      return;
    }
    store_brick(ref, low, plan.bricks_[plan.applied_++].content, removed);
    return;
  }
  if ((ref & k_kind) == k_uniform) {
    if (nodes_.full()) {
      plan.out_of_room_ = true;
      return;
    }
    Node split;
    split.child.fill(ref);
    ref = k_node | nodes_.add(split);
    ++version_;
  }
  const std::uint32_t node = ref & k_index;
  const std::uint32_t part = 1u << 3 * (level - 1);
  bool all_equal = true;
  for (std::uint32_t i = 0; i < 8; ++i) {
    std::uint32_t child = nodes_.items[node].child[i];
    if (!plan.out_of_room_ && plan.applied_ < plan.bricks_.size() &&
        plan.bricks_[plan.applied_].place < place + (i + 1) * part) {
      apply_in(child, level - 1, low_of_child(low, i, k_brick_edge << (level - 1)),
               place + i * part, plan, removed);
      nodes_.items[node].child[i] = child;
    }
    all_equal = all_equal && (child & k_kind) == k_uniform && child == nodes_.items[node].child[0];
  }
  if (all_equal) {
    ref = nodes_.items[node].child[0];
    nodes_.release(node);
    ++version_;
  }
}

void Octree::store_brick(std::uint32_t& ref, IVec3 low, const FullBrick& brick,
                         std::vector<RemovedLeaf>& removed) noexcept {
  const auto before = labels_of(ref);
  for (int block = 0; block < 8; ++block) {
    const std::uint64_t were =
        before.mask == 0 ? k_each_byte * before.first[0] : bytes_of_block(before.first, block);
    std::uint64_t differ = were ^ bytes_of_block(brick.tissue.data(), block);
    while (differ != 0) {
      const int at = std::countr_zero(differ) & ~7;  // bits before the first leaf that differs
      differ &= ~(std::uint64_t{0xff} << at);
      const int i = first_of_block(block) + k_leaf_of_block[static_cast<std::size_t>(at / 8)];
      const IVec3 leaf = low + IVec3{i & 3, i >> 2 & 3, i >> 4};
      removed.push_back({static_cast<std::int16_t>(leaf.x), static_cast<std::int16_t>(leaf.y),
                         static_cast<std::int16_t>(leaf.z), static_cast<std::uint8_t>(were >> at),
                         0});
    }
  }
  const std::uint64_t key = static_cast<std::uint64_t>(low.x) |
                            static_cast<std::uint64_t>(low.y) << 16 |
                            static_cast<std::uint64_t>(low.z) << 32;
  edit_hash_ = fast_hash(&brick, sizeof brick, edit_hash_ ^ key);
  if (!marks_.empty()) marks_[mark_of(low)] = edit_hash_;
  if ((ref & k_kind) == k_full_brick) {
    static const FullBrick air = [] {
      FullBrick b;
      b.tissue.fill(k_air);
      b.distance.fill(k_distance_far);
      return b;
    }();
    if (std::memcmp(&brick, &air, sizeof air) != 0) {
      bricks_.items[ref & k_index] = brick;
      return;
    }
    bricks_.release(ref & k_index);
    ref = k_uniform | k_air;
  } else {
    if ((ref & k_kind) == k_label_brick) labels_.release(ref & k_index);
    ref = canonical(brick);
  }
  ++version_;
}

void Octree::reserve_edits(std::size_t bricks) {
  bricks_.reserve(bricks);
  labels_.reserve(bricks);
  nodes_.reserve(bricks);
  if (marks_.empty()) marks_.resize(mark_of(size_) + 1, edit_hash_);
}

}  // namespace cavum
