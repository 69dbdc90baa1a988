// Carving the octree by a shape, and visiting its cubes: the templates that octree.h declares. Who
// carves or visits includes this.
#pragma once

#include <algorithm>
#include <limits>
#include <type_traits>

#include "engine/tooth/octree.h"

namespace cavum {

struct Octree::Planning {
  IVec3 low, high;  // leaves that may change, inclusive
  double clearance_mm, band_mm;
  int work;
  Plan& plan;
};

/// A shape that turns a brick into its own frame once, and then knows the distances at eight of its
/// leaves at once, in single precision.
template <class Shape>
concept KnowsBricks = requires(const Shape& shape, float* out) {
  shape.brick(Vec3{}).of_blocks(out);
  shape.brick(Vec3{}).of_leaves(0, out);
};

/// A shape that can tell for a ball, or a block of a brick, whether an earlier carve did all of it
/// already.
template <class Shape>
concept KnowsUnchanged = requires(const Shape& shape) {
  shape.unchanged(Vec3{}, 1.0);
};
inline constexpr double k_half_diagonal = 1.7320508075688773;  ///< of a cube, in half edges

/// A brick whose lowest corner is `low_mm`, for any shape.
template <class Shape>
struct PlainBrick {
  const Shape& shape;
  Vec3 low_mm;
  double leaf_mm;
  /// Distances at the centres of its eight blocks of 2x2x2 leaves, x fastest.
  void of_blocks(double* out) const noexcept { corners({1, 1, 1}, 2, out); }
  /// Distances at the centres of the eight leaves of a block.
  void of_leaves(int block, double* out) const noexcept {
    corners({(block & 1) * 2 + 0.5, (block >> 1 & 1) * 2 + 0.5, (block >> 2) * 2 + 0.5}, 1, out);
  }

 private:
  void corners(Vec3 first, double apart, double* out) const noexcept {
    for (int i = 0; i < 8; ++i)
      out[i] =
          shape(low_mm + (first + Vec3{double(i & 1), double(i >> 1 & 1), double(i >> 2)} * apart) *
                             leaf_mm);
  }
};
template <class Shape>
auto brick_of(const Shape& shape, Vec3 low_mm, double leaf_mm) noexcept {
  if constexpr (KnowsBricks<Shape>)
    return shape.brick(low_mm);
  else
    return PlainBrick<Shape>{shape, low_mm, leaf_mm};
}

/// A vector type of four.
template <class Real>
struct FourOf;
template <>
struct FourOf<float> {
  using type = float __attribute__((vector_size(16)));
};
template <>
struct FourOf<double> {
  using type = double __attribute__((vector_size(32)));
};

/// Eight distances, mm, and what they are as codes: in vector types, of which every compiler and
/// machine makes the same.
template <class Real>
struct EightDistances {
  alignas(16) Real mm[8];
  /// `encode_distance` of `clearance_mm - mm`, and -1 for each that is negative, else 0.
  void encode(Real clearance_mm, Real codes_per_mm, std::int16_t* code,
              std::int16_t* inside) const noexcept {
    using Four = typename FourOf<Real>::type;
    using FourWhole = std::int32_t __attribute__((vector_size(16)));
    using FourCodes = std::int16_t __attribute__((vector_size(8)));
    constexpr Real k_far = k_distance_far;
    for (std::size_t first = 0; first < 8; first += 4) {
      Four d;
      std::memcpy(&d, mm + first, sizeof d);
      Four at = (clearance_mm - d) * codes_per_mm;
      at = at < -k_far ? Four{} - k_far : at;
      at = at > k_far ? Four{} + k_far : at;
      const FourWhole whole =
          __builtin_convertvector(at + (k_far + Real{0.5}), FourWhole) - k_distance_far;
      const auto codes = __builtin_convertvector(whole, FourCodes),
                 negative = __builtin_convertvector(d < Real{0}, FourCodes);
      std::memcpy(code + first, &codes, sizeof codes);
      std::memcpy(inside + first, &negative, sizeof negative);
    }
  }
};
/// Single precision for shapes that offer it.
template <class Shape>
using BlockDistances = EightDistances<std::conditional_t<KnowsBricks<Shape>, float, double>>;

template <class Shape>
bool Octree::carve(Vec3 low_mm, Vec3 high_mm, const Shape& shape, std::vector<RemovedLeaf>& removed,
                   double clearance_mm) {
  Plan steps;
  for (bool all = false; !all;) {
    all = plan(low_mm, high_mm, shape, clearance_mm, std::numeric_limits<int>::max(), steps);
    if (!apply(steps, removed)) return false;
  }
  return true;
}

template <class Shape>
bool Octree::plan(Vec3 low_mm, Vec3 high_mm, const Shape& shape, double clearance_mm, int work,
                  Plan& plan) const noexcept {
  Planning planning{clamp_to_tree(low_mm),
                    clamp_to_tree(high_mm),
                    clearance_mm,
                    k_distance_band_leaves * leaf_mm_ + clearance_mm,
                    work,
                    plan};
  plan_in(root_, levels_, {0, 0, 0}, 0, shape, planning);
  if (planning.work <= 0 || plan.full()) return false;
  plan.next_ = 0;
  return true;
}

template <class Shape>
void Octree::plan_in(std::uint32_t ref, int level, IVec3 low, std::uint32_t place,
                     const Shape& shape, Planning& planning) const noexcept {
  if (planning.work <= 0 || planning.plan.full() || ref == (k_uniform | k_air)) return;
  const std::uint32_t end = place + (1u << 3 * level);
  if (end <= planning.plan.next_) return;  // planned in an earlier part
  const int edge = k_brick_edge << level;
  if (low.x > planning.high.x || low.y > planning.high.y || low.z > planning.high.z) return;
  if (low.x + edge <= planning.low.x || low.y + edge <= planning.low.y ||
      low.z + edge <= planning.low.z)
    return;
  // The shape's distance changes by at most 1 mm per mm: the centre speaks for the whole cube.
  const double half_mm = 0.5 * edge * leaf_mm_;
  const Vec3 middle = origin_mm_ + to_vec3(low) * leaf_mm_ + Vec3{half_mm, half_mm, half_mm};
  const double radius_mm = half_mm * k_half_diagonal;
  --planning.work;
  if (shape(middle) > radius_mm + planning.band_mm) return;
  if constexpr (KnowsUnchanged<Shape>)
    if (shape.unchanged(middle, radius_mm)) return;
  if (level > 0) {
    for (std::uint32_t i = 0; i < 8; ++i)
      plan_in((ref & k_kind) == k_node ? nodes_.items[ref & k_index].child[i] : ref, level - 1,
              low_of_child(low, i, edge / 2), place + (i << 3 * (level - 1)), shape, planning);
    return;
  }
  planning.plan.next_ = end;
  constexpr int k_brick_work = 6;
  planning.work -= k_brick_work;
  // 2x2x2 leaves at a time: a block whose centre is far outside the shape is passed over
  const auto in_shape = brick_of(shape, origin_mm_ + to_vec3(low) * leaf_mm_, leaf_mm_);
  BlockDistances<Shape> blocks;
  in_shape.of_blocks(blocks.mm);
  const auto far_mm = static_cast<std::remove_cvref_t<decltype(blocks.mm[0])>>(
      0.5 * leaf_mm_ * k_half_diagonal + planning.band_mm);
  unsigned near = 0;
  for (unsigned block = 0; block < 8; ++block)
    near |= (blocks.mm[block] > far_mm ? 0u : 1u) << block;
  if (near == 0) return;
  auto& bricks = planning.plan.bricks_;
  bricks.emplace_back();
  bricks.back().place = place;
  bricks.back().content = expanded(ref);
  if (!cut_brick<Shape>(in_shape, near, planning, bricks.back().content)) bricks.pop_back();
}

/// Cuts the blocks `near` (as bits) of a copy of a brick; false when nothing changed.
template <class Shape, class Brick>
bool Octree::cut_brick(const Brick& in_shape, unsigned near, Planning& planning,
                       FullBrick& brick) const noexcept {
  BlockDistances<Shape> leaves;
  using Real = std::remove_cvref_t<decltype(leaves.mm[0])>;
  const auto codes_per_mm = static_cast<Real>(k_distance_far / (k_distance_band_leaves * leaf_mm_)),
             clearance_mm = static_cast<Real>(planning.clearance_mm);
  const auto solid_most = static_cast<std::int16_t>(
      planning.clearance_mm > 0.0 ? encode_distance(planning.clearance_mm / leaf_mm_) : -1);
  bool changed = false;
  constexpr int k_block_work = 5;
  for (; near != 0; near &= near - 1) {
    const int block = std::countr_zero(near);
    if (is_empty_block(brick, block)) continue;
    if constexpr (KnowsUnchanged<Shape>)
      if (in_shape.unchanged(block)) continue;
    planning.work -= k_block_work;
    in_shape.of_leaves(block, leaves.mm);
    std::int16_t cut[8], inside[8];
    leaves.encode(clearance_mm, codes_per_mm, cut, inside);
    changed |= cut_block(brick, block, eight_of(cut), eight_of(inside), solid_most);
  }
  return changed;
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
