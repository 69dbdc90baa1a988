// Where the surface of solid tissue lies beside a leaf, by the distance that the octree keeps.
#pragma once

#include "engine/tooth/octree.h"

namespace cavum::grading {

/// One of the six neighbours is solid.
[[nodiscard]] bool beside_solid(const Octree& tree, IVec3 leaf, Octree::Cursor& cursor);

/// A place on the surface; `normal` is unit, out of the solid, 0 where the distance does not say.
struct SurfacePosition {
  Vec3 at_mm, normal;
};
/// The one nearest to a leaf's centre, at most a leaf from it.
[[nodiscard]] SurfacePosition surface_by(const Octree& tree, IVec3 leaf, Octree::Cursor& cursor);

/// How far the surface lies from the centre of a leaf that is gone, or of one that stays: leaves,
/// at least 0.01, on the right side even where the octree's distance says otherwise.
[[nodiscard]] double gone_by(const Octree& after, IVec3 leaf);
[[nodiscard]] double stays_by(const Octree& after, IVec3 leaf);

}  // namespace cavum::grading
