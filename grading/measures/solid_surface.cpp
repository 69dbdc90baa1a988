#include "grading/measures/solid_surface.h"

#include <algorithm>

#include "scenarios/zones/zone_map.h"

namespace cavum::grading {

bool beside_solid(const Octree& tree, IVec3 leaf, Octree::Cursor& cursor) {
  return std::any_of(std::begin(scenarios::k_six_neighbours), std::end(scenarios::k_six_neighbours),
                     [&](IVec3 step) { return tree.is_solid(tree.tissue(leaf + step, cursor)); });
}

SurfacePosition surface_by(const Octree& tree, IVec3 leaf, Octree::Cursor& cursor) {
  const Vec3 centre = tree.centre_mm(leaf);
  const SurfaceSample s = tree.sample(centre, cursor);
  const double steep = length(s.gradient);
  const Vec3 normal = steep > 0.1 ? s.gradient / steep : Vec3{0, 0, 0};
  return {centre - normal * std::clamp(s.distance_mm, -tree.leaf_mm(), tree.leaf_mm()), normal};
}

double gone_by(const Octree& after, IVec3 leaf) {
  return std::max(decode_distance(after.distance_code(leaf)), 0.01);
}
double stays_by(const Octree& after, IVec3 leaf) {
  return std::max(-decode_distance(after.distance_code(leaf)), 0.01);
}

}  // namespace cavum::grading
