#include "engine/physics/cutting/carve_head.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/tooth/octree_edit.h"

namespace cavum {
namespace {

/// From the lowest corner of a cube to eight places in it, tool frame, mm.
struct Places {
  float x[8], y[8], z[8];
  Places(const Mat3& rotation, double first_mm, double apart_mm) {
    for (int i = 0; i < 8; ++i) {
      const Vec3 to =
          rotation.transposed(Vec3{first_mm, first_mm, first_mm} +
                              Vec3{double(i & 1), double(i >> 1 & 1), double(i >> 2)} * apart_mm);
      x[i] = static_cast<float>(to.x);
      y[i] = static_cast<float>(to.y);
      z[i] = static_cast<float>(to.z);
    }
  }
};

/// The head at a pose, as the octree asks for it.
struct HeadShape {
  const Bur& bur;
  Vec3 tip_mm;
  const Mat3& rotation;
  double leaf_mm;
  Places centres, corners,
      leaves;  // of a brick's blocks, their lowest corners, and the leaves of a block from there
  bool only_leading = false;
  Vec3 way{};            // of the tip since the last carve, tool frame
  double across_mm = 0;  // its part across the axis
  double band_mm = 0;    // leaves inside the head change too, as far as distances are kept

  HeadShape(const Bur& head, Vec3 tip, const Mat3& turned, double leaf)
      : bur(head),
        tip_mm(tip),
        rotation(turned),
        leaf_mm(leaf),
        centres(turned, leaf, 2 * leaf),
        corners(turned, 0, 2 * leaf),
        leaves(turned, 0.5 * leaf, leaf) {}

  /// A lower bound of the distance, for the large cubes of the tree.
  double operator()(Vec3 mm) const noexcept {
    const Vec3 at = rotation.transposed(mm - tip_mm);
    const double over = std::max(-at.z, at.z - bur.cutting_length_mm),
                 aside = std::sqrt(at.x * at.x + at.y * at.y) - bur.head_radius_mm;
    return std::max(over, aside);
  }

  /// A brick of 4x4x4 leaves in the tool frame, in single precision relative to the tip: a
  /// nanometre.
  struct Brick {
    const HeadShape& head;
    float x, y, z;  // lowest corner
    /// Distances at the centres of its blocks of 2x2x2 leaves, x fastest.
    void of_blocks(float* out) const noexcept { head.distances_mm(x, y, z, head.centres, out); }
    /// Distances at the centres of the leaves of a block.
    void of_leaves(int block, float* out) const noexcept {
      head.distances_mm(x + head.corners.x[block], y + head.corners.y[block],
                        z + head.corners.z[block], head.leaves, out);
    }
    [[nodiscard]] bool unchanged(int block) const noexcept {
      return head.only_leading && head.unchanged_in_tool({double{x + head.centres.x[block]},
                                                          double{y + head.centres.y[block]},
                                                          double{z + head.centres.z[block]}},
                                                         0.5 * head.leaf_mm * k_half_diagonal);
    }
  };
  [[nodiscard]] Brick brick(Vec3 low_mm) const noexcept {
    const Vec3 low = rotation.transposed(low_mm - tip_mm);
    return {*this, static_cast<float>(low.x), static_cast<float>(low.y), static_cast<float>(low.z)};
  }
  /// In loops of fixed length, which compilers turn into vectors.
  void distances_mm(float x0, float y0, float z0, const Places& to, float* out) const noexcept {
    float r[8], z[8];
    for (int i = 0; i < 8; ++i) {
      const float x = x0 + to.x[i], y = y0 + to.y[i];
      r[i] = std::sqrt(x * x + y * y);
      z[i] = z0 + to.z[i];
    }
    bur.field.distances_mm(r, z, out);
  }

  [[nodiscard]] bool unchanged(Vec3 centre_mm, double radius_mm) const noexcept {
    return only_leading && unchanged_in_tool(rotation.transposed(centre_mm - tip_mm), radius_mm);
  }
  /// The distance to a convex body that moved by `way` can fall at x only where the surface nearest
  /// to x faced along the way before the move (distances to convex bodies are convex). Faces of a
  /// body of revolution: sideways within the half turn about x, downwards only below the height
  /// where the head is widest, upwards only above the height where it begins to narrow.
  [[nodiscard]] bool unchanged_in_tool(Vec3 centre_mm, double radius_mm) const noexcept {
    const Vec3 c = centre_mm + way;  // as it lay before the move
    if (across_mm > 0 && c.x * way.x + c.y * way.y + radius_mm * across_mm > 0) return false;
    if (way.z < 0 && c.z - radius_mm < bur.widest_from_mm + band_mm) return false;
    if (way.z > 0 && c.z + radius_mm > bur.widest_to_mm - band_mm) return false;
    return true;
  }
};

}  // namespace

void begin_carving(HeadCarving& carving, const CarvedHead& head) noexcept {
  carving.now = head;
  carving.plan.clear();
  carving.worked_out = false;
  carving.swept_mm = 0.0;
}

void drop_carving(HeadCarving& carving) noexcept { carving.now.bur = -1; }

CarvingStep go_on_carving(HeadCarving& carving, Octree& tooth, const Bur& head, int work,
                          std::vector<RemovedLeaf>& removed) noexcept {
  const CarvedHead &now = carving.now, &last = carving.last;
  bool all = carving.worked_out;
  if (!all && !carving.plan.full()) {
    const double leaf = tooth.leaf_mm();
    // The head's box: the capsule around its axis, and the band of distances that changes around
    // it.
    const double r = head.head_radius_mm + (k_distance_band_leaves + 1.0) * leaf;
    const Vec3 end = now.tip_mm + now.rotation * Vec3{0, 0, head.cutting_length_mm};
    const Vec3 low{std::min(now.tip_mm.x, end.x) - r, std::min(now.tip_mm.y, end.y) - r,
                   std::min(now.tip_mm.z, end.z) - r};
    const Vec3 high{std::max(now.tip_mm.x, end.x) + r, std::max(now.tip_mm.y, end.y) + r,
                    std::max(now.tip_mm.z, end.z) + r};
    HeadShape shape(head, now.tip_mm, now.rotation, leaf);
    if (last.bur == now.bur && last.rotation == now.rotation) {
      shape.only_leading = true;
      shape.band_mm = (k_distance_band_leaves + 0.25) * leaf;
      shape.way = now.rotation.transposed(now.tip_mm - last.tip_mm);
      shape.across_mm = std::sqrt(shape.way.x * shape.way.x + shape.way.y * shape.way.y);
    }
    // Trilinear interpolation of a hollow of radius R lies leaf²/(8R) a direction inside it,
    // rounding of the codes adds 0.01 leaf.
    const double clearance_mm = leaf * (0.01 + 0.25 * leaf / head.smallest_radius_mm);
    carving.worked_out = all = tooth.plan(low, high, shape, clearance_mm, work, carving.plan);
    if (work < k_at_once) return CarvingStep::under_way;
  }
  const bool room = tooth.apply(carving.plan, removed);
  if (room && !all)
    return work < k_at_once ? CarvingStep::under_way
                            : go_on_carving(carving, tooth, head, work, removed);
  carving.last = room ? now : CarvedHead{};
  carving.now.bur = -1;
  return room ? CarvingStep::done : CarvingStep::no_room;
}

}  // namespace cavum
