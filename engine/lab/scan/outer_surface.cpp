#include "engine/lab/scan/outer_surface.h"

#include <algorithm>
#include <cmath>

namespace cavum {
namespace {

constexpr double k_tooth_point_mm = 0.15, k_index_cell_mm = 0.2, k_index_margin_mm = 4.0;
constexpr double k_by_octree_mm = 0.5;  // of the octree's distances none that is of the pulp's wall

}  // namespace

OuterSurface::OuterSurface(const Tooth& tooth) : tooth_(tooth) {
  outside_ = tissues_around_tooth(tooth);
  const TriangleMesh mesh = outer_surface(tooth, outside_);
  outside_[k_air] = true;
  points_ = surface_points(mesh, k_tooth_point_mm, msg("tooth"));
  index_ = SurfaceIndex(points_, k_index_cell_mm, k_index_margin_mm);
  const double in_mm = 0.75 * tooth.octree.leaf_mm();
  for (const auto& p : points_)
    if (tooth.octree.tissue_at(p.at_mm - p.normal * in_mm) == k_enamel) crown_.push_back(p);
  if (crown_.empty()) crown_ = points_;
}

OuterSurface::Distance OuterSurface::distance(Vec3 p, Octree::Cursor& cursor) const noexcept {
  const SurfaceIndex::Place& near = index_.near(p);
  const double away = length(p - near.at_mm);
  if (away < k_by_octree_mm) {
    const SurfaceSample s = tooth_.octree.sample(p, cursor);
    const double steep = length(s.gradient);
    if (std::fabs(s.distance_mm) < 0.9 * band_mm() && steep > 0.5)
      return {s.distance_mm, s.gradient / steep};
  }
  const double plane = near.plane_mm(p);
  return {away < 1.0 ? plane : std::copysign(away, plane), near.normal};
}

double OuterSurface::at_leaf_mm(IVec3 leaf) const noexcept {
  constexpr double k_far_mm = 1e9;
  const Octree& octree = tooth_.octree;
  const bool out = outside_[octree.tissue(leaf)];
  const Vec3 p = octree.centre_mm(leaf);
  const int code = octree.distance_code(leaf);
  if (std::abs(code) == k_distance_far ||
      length(p - index_.near(p).at_mm) > band_mm() + 2 * k_index_cell_mm)
    return out ? k_far_mm : -k_far_mm;
  const double mm = std::fabs(decode_distance(code)) * octree.leaf_mm();
  return out ? mm : -mm;
}

}  // namespace cavum
