// Templates of the octree: carving by a shape and visiting cubes. Included by octree.h only.
#pragma once

#include <algorithm>
#include <type_traits>

#include "engine/base/hash.h"
#include "engine/tooth/octree.h"

namespace cavum {

struct Octree::Edit {
  IVec3 low, high;  // leaves that may change, inclusive
  std::vector<RemovedLeaf>& removed;
  double clearance_mm, band_mm;
  bool complete = true;
};

/// A shape that knows the distances at eight leaves at once, in single precision.
template <class Shape>
concept KnowsCorners = requires(const Shape& shape, float* out) {
  shape.at_corners(Vec3{}, true, out);
};

/// A shape that can tell for a ball whether an earlier carve did all of it already.
template <class Shape>
concept KnowsUnchanged = requires(const Shape& shape) {
  shape.unchanged(Vec3{}, 1.0);
};
inline constexpr double k_half_diagonal = 1.7320508075688773;  ///< of a cube, in half edges

/// The shape's distances at the centres of 2x2x2 leaves, or of 2x2x2 blocks of 2x2x2 leaves, x fastest.
template <class Shape, class Real>
void corner_distances(const Shape& shape, Vec3 low_mm, double leaf_mm, bool of_blocks, Real* out) noexcept {
  if constexpr (KnowsCorners<Shape>) {
    shape.at_corners(low_mm, of_blocks, out);
  } else {
    const double apart_mm = of_blocks ? 2 * leaf_mm : leaf_mm;
    for (int i = 0; i < 8; ++i) out[i] = shape(low_mm + Vec3{double(i & 1), double(i >> 1 & 1), double(i >> 2)} * apart_mm);
  }
}

template <class Shape>
bool Octree::carve(Vec3 low_mm, Vec3 high_mm, const Shape& shape, std::vector<RemovedLeaf>& removed, double clearance_mm) noexcept {
  Edit edit{clamp_to_tree(low_mm), clamp_to_tree(high_mm), removed, clearance_mm, k_distance_band_leaves * leaf_mm_ + clearance_mm};
  carve_in(root_, levels_, {0, 0, 0}, shape, edit);
  return edit.complete;
}

template <class Shape>
void Octree::carve_in(std::uint32_t& ref, int level, IVec3 low, const Shape& shape, Edit& edit) noexcept {
  if (ref == (k_uniform | k_air) || !edit.complete) return;
  const int edge = k_brick_edge << level;
  if (low.x > edit.high.x || low.y > edit.high.y || low.z > edit.high.z) return;
  if (low.x + edge <= edit.low.x || low.y + edge <= edit.low.y || low.z + edge <= edit.low.z) return;
  // The shape's distance changes by at most 1 mm per mm: the centre speaks for the whole cube.
  const double half_mm = 0.5 * edge * leaf_mm_;
  const Vec3 middle = origin_mm_ + Vec3{double(low.x), double(low.y), double(low.z)} * leaf_mm_ + Vec3{half_mm, half_mm, half_mm};
  const double radius_mm = half_mm * k_half_diagonal;
  if (shape(middle) > radius_mm + edit.band_mm) return;
  if constexpr (KnowsUnchanged<Shape>)
    if (shape.unchanged(middle, radius_mm)) return;
  if (level == 0) {
    carve_brick(ref, low, shape, edit);
    return;
  }
  if ((ref & k_kind) == k_uniform) {
    if (nodes_.full()) {
      edit.complete = false;
      return;
    }
    Node split;
    split.child.fill(ref);
    ref = k_node | nodes_.add(split);
    ++version_;
  }
  const std::uint32_t node = ref & k_index;
  const int half = edge / 2;
  bool all_equal = true;
  for (int i = 0; i < 8; ++i) {
    std::uint32_t child = nodes_.items[node].child[static_cast<std::size_t>(i)];
    carve_in(child, level - 1, low + IVec3{(i & 1) * half, (i >> 1 & 1) * half, (i >> 2) * half}, shape, edit);
    nodes_.items[node].child[static_cast<std::size_t>(i)] = child;
    all_equal = all_equal && (child & k_kind) == k_uniform && child == nodes_.items[node].child[0];
  }
  if (all_equal) {
    ref = nodes_.items[node].child[0];
    nodes_.release(node);
    ++version_;
  }
}

template <class Shape>
void Octree::carve_brick(std::uint32_t& ref, IVec3 low, const Shape& shape, Edit& edit) noexcept {
  if (bricks_.full() || labels_.full() || edit.removed.capacity() - edit.removed.size() < k_brick_leaves) {
    edit.complete = false;
    return;
  }
  // 2x2x2 leaves at a time: a block whose centre is far outside the shape is passed over
  using Real = std::conditional_t<KnowsCorners<Shape>, float, double>;
  const auto skip_mm = static_cast<Real>(0.5 * leaf_mm_ * k_half_diagonal + edit.band_mm);
  const auto codes_per_mm = static_cast<Real>(k_distance_far / (k_distance_band_leaves * leaf_mm_)),
             clearance_mm = static_cast<Real>(edit.clearance_mm);
  const int solid_most = edit.clearance_mm > 0.0 ? int{encode_distance(edit.clearance_mm / leaf_mm_)} : -1;
  Real block_mm[8], tool_mm[8];
  corner_distances(shape, origin_mm_ + Vec3{low.x + 1.0, low.y + 1.0, low.z + 1.0} * leaf_mm_, leaf_mm_, true, block_mm);
  if (*std::min_element(block_mm, block_mm + 8) > skip_mm) return;
  FullBrick brick = expanded(ref);
  bool changed = false;
  for (int block = 0; block < 8; ++block) {
    if (block_mm[block] > skip_mm || is_empty_block(brick, block)) continue;
    const IVec3 at = low + IVec3{(block & 1) * 2, (block >> 1 & 1) * 2, (block >> 2) * 2};
    const Vec3 first_mm = centre_mm(at);
    if constexpr (KnowsUnchanged<Shape>) {
      const double half = 0.5 * leaf_mm_;
      if (shape.unchanged(first_mm + Vec3{half, half, half}, half * k_half_diagonal)) continue;
    }
    corner_distances(shape, first_mm, leaf_mm_, false, tool_mm);
    int cut_code[8];
    for (int i = 0; i < 8; ++i) {  // encode_distance, eight at a time
      constexpr Real k_far = k_distance_far;
      const Real code = std::min(std::max((clearance_mm - tool_mm[i]) * codes_per_mm, -k_far), k_far);
      cut_code[i] = static_cast<int>(code + (k_far + Real{0.5})) - k_distance_far;
    }
    for (int inner = 0; inner < 8; ++inner) {
      const auto i = static_cast<std::size_t>(first_of_block(block) + k_leaf_of_block[inner]);
      int code = brick.distance[i];
      const bool removed = tool_mm[inner] < 0 && brick.tissue[i] != k_air;
      if (cut_code[inner] <= code && !removed) continue;
      if (removed) {
        const IVec3 leaf = at + IVec3{inner & 1, inner >> 1 & 1, inner >> 2};
        edit.removed.push_back(
            {static_cast<std::int16_t>(leaf.x), static_cast<std::int16_t>(leaf.y), static_cast<std::int16_t>(leaf.z), brick.tissue[i], 0});
        brick.tissue[i] = k_air;
      }
      // A solid leaf stays inside the surface, or outside it by no more than the clearance: cut on both sides of a tool whose
      // width is a whole number of leaves, such leaves would hold it.
      code = solid_[brick.tissue[i]] ? std::max(code, std::min(cut_code[inner], solid_most)) : std::max({code, cut_code[inner], 1});
      changed = changed || removed || code != brick.distance[i];
      brick.distance[i] = static_cast<std::int8_t>(code);
    }
  }
  if (!changed) return;
  const std::uint64_t key = static_cast<std::uint64_t>(low.x) | static_cast<std::uint64_t>(low.y) << 16 | static_cast<std::uint64_t>(low.z) << 32;
  edit_hash_ = fast_hash(&brick, sizeof brick, edit_hash_ ^ key);
  if ((ref & k_kind) == k_full_brick) {
    FullBrick& mine = bricks_.items[ref & k_index];
    bool empty = true;
    for (std::size_t j = 0; j < k_brick_leaves && empty; ++j) empty = brick.tissue[j] == k_air && brick.distance[j] == k_distance_far;
    if (!empty) {
      mine = brick;
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

template <class Visit>
void Octree::for_each_cube(const Visit& visit) const {
  visit_cubes(root_, levels_, {0, 0, 0}, visit);
}

template <class Visit>
void Octree::visit_cubes(std::uint32_t ref, int level, IVec3 low, const Visit& visit) const {
  const int edge = k_brick_edge << level;
  if ((ref & k_kind) == k_uniform) {
    if ((ref & k_index) != k_air) visit(low, edge, static_cast<std::uint8_t>(ref & k_index));
    return;
  }
  if ((ref & k_kind) == k_node) {
    const int half = edge / 2;
    for (int i = 0; i < 8; ++i)
      visit_cubes(nodes_.items[ref & k_index].child[static_cast<std::size_t>(i)], level - 1,
                  low + IVec3{(i & 1) * half, (i >> 1 & 1) * half, (i >> 2) * half}, visit);
    return;
  }
  for (int i = 0; i < k_brick_leaves; ++i) {
    const auto t = tissue_in(ref, i);
    if (t != k_air) visit(low + IVec3{i & 3, i >> 2 & 3, i >> 4}, 1, t);
  }
}

}  // namespace cavum
