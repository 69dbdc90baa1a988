#include "scenarios/zones/placed.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/tooth/anatomy/polylines.h"
#include "scenarios/file/bodies.h"
#include "scenarios/zones/outline.h"

namespace cavum::scenarios {
namespace {

constexpr double k_line_mm = 0.03;   // a line is known so well with fewer points
constexpr double k_beyond_mm = 3.0;  // out of the tooth
constexpr std::size_t k_fewest = 2;  // points of a line

Vec3 flat(Vec3 p) { return {p.x, p.y, 0}; }

/// Points between `first` and `last` that the line needs (Douglas and Peucker).
void keep_points(const Polyline& line, std::size_t first, std::size_t last,
                 std::vector<Vec3>& kept) {
  double furthest_mm = 0;
  std::size_t at = first;
  for (std::size_t i = first + 1; i < last; ++i)
    if (const double d = segment_distance(flat(line[i]), flat(line[first]), flat(line[last]));
        d > furthest_mm) {
      furthest_mm = d;
      at = i;
    }
  if (furthest_mm > k_line_mm) {
    keep_points(line, first, at, kept);
    keep_points(line, at, last, kept);
    return;
  }
  kept.push_back(flat(line[last]));
}

std::vector<Vec3> simplified(const Polyline& line) {
  std::vector<Vec3> kept;
  if (line.size() < k_fewest) return kept;
  kept.push_back(flat(line[0]));
  keep_points(line, 0, line.size() - 1, kept);
  return kept;
}

/// The line from where it is at least `away_mm` from `place`, going from its first point on. Empty
/// when it never is.
Polyline begun_away_from(const Polyline& line, Vec3 place, double away_mm) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double d = length(flat(line[i] - place));
    if (d < away_mm) continue;
    Polyline rest(line.begin() + static_cast<std::ptrdiff_t>(i), line.end());
    if (i == 0) return rest;
    const double before = length(flat(line[i - 1] - place)),
                 share = (away_mm - before) / std::max(1e-9, d - before);
    rest.insert(rest.begin(), line[i - 1] + (line[i] - line[i - 1]) * share);
    return rest;
  }
  return {};
}

Polyline reversed(Polyline line) {
  std::reverse(line.begin(), line.end());
  return line;
}

/// The line's beginning kept away from a ridge, or led through it.
Polyline begun_at_ridge(Polyline line, const MarginalRidge& ridge, double away_mm, bool through) {
  if (!ridge.lowest_mm) return line;
  if (!through) return begun_away_from(line, *ridge.lowest_mm, away_mm);
  line.insert(line.begin(), *ridge.lowest_mm);
  const Vec3 out = normalized(flat(line[0] - line[1]));
  line.insert(line.begin(), line[0] + out * k_beyond_mm);
  return line;
}

}  // namespace

bool follows_landmarks(const ZoneSpec& zones) noexcept {
  const auto does = [](const ShapeSpec& s) {
    return body_is(s, k_by_landmarks) || s.leans || s.outline.kind == OutlineSpec::Kind::fissure;
  };
  return std::any_of(zones.target.begin(), zones.target.end(), does) ||
         std::any_of(zones.protected_shapes.begin(), zones.protected_shapes.end(), does);
}

OutlineSpec place_fissure(const OutlineSpec& spec, const Landmarks& landmarks,
                          const Message& where) {
  if (landmarks.central_fissure_mm.size() < k_fewest)
    throw Error(
        where, msg("no central fissure is found on this tooth"),
        msg("look at `cavum tooth landmarks`, set its pits there, or draw the outline yourself"));
  OutlineSpec placed = spec;
  const double away_mm = spec.ridge_mm + 0.5 * spec.width_mm;
  Polyline line = begun_at_ridge(landmarks.central_fissure_mm, landmarks.mesial_ridge, away_mm,
                                 spec.through > 0);
  if (line.size() >= k_fewest)
    line =
        reversed(begun_at_ridge(reversed(line), landmarks.distal_ridge, away_mm, spec.through < 0));
  if (line.size() < k_fewest)
    throw Error(
        where,
        msg("nothing of the fissure is {} away from both marginal ridges", as_mm(away_mm, 2)),
        msg("make 'ridge_mm' or 'width_mm' smaller"));
  placed.paths_mm.push_back(simplified(line));
  placed.bottom_line_mm = landmarks.central_fissure_mm;
  if (spec.branches)
    for (const Polyline& branch : landmarks.fissure_branches_mm)
      if (branch.size() >= k_fewest) placed.paths_mm.push_back(simplified(branch));
  return placed;
}

ShapeSpec place_proximal_box(const ShapeSpec& spec, const Tooth& tooth, const Landmarks& landmarks,
                             const Message& where) {
  const std::string_view side = spec.side > 0 ? "mesial" : "distal";
  const Vec3 *contact = furthest_along(landmarks.height_of_contour_mm, Vec3{1.0 * spec.side, 0, 0}),
             *neck = furthest_along(landmarks.neck_mm, Vec3{1.0 * spec.side, 0, 0});
  if (contact == nullptr || neck == nullptr)
    throw Error(where, msg("no {} contact area or no neck is found on this tooth", side),
                msg("look at `cavum tooth landmarks`, or place the box yourself"));
  const Octree& tree = tooth.octree;
  const double leaf = tree.leaf_mm(), floor_mm = neck->z + spec.above_neck_mm;
  if (floor_mm > contact->z + 1.0)
    throw Error(
        where,
        msg("the box's floor lies {} above the {} contact", as_mm(floor_mm - contact->z, 2), side),
        msg("make 'above_neck_mm' smaller"));
  // the outer surface just above the floor, coming from outside
  const double beyond_mm =
      tree.origin_mm().x + (spec.side > 0 ? static_cast<double>(tree.size().x) * leaf : 0.0);
  double surface_mm = beyond_mm;
  const auto air = [&](double x) {
    return !tree.is_solid(tree.tissue_at({x, contact->y, floor_mm + leaf}));
  };
  while (surface_mm * spec.side > 0 && air(surface_mm)) surface_mm -= 0.5 * leaf * spec.side;
  if (air(surface_mm))
    throw Error(where, msg("the tooth ends below the box's floor at the {} side", side),
                msg("make 'above_neck_mm' smaller"));
  ShapeSpec box = spec;
  box.kind = ShapeSpec::Kind::box;
  const double axial_mm = surface_mm - spec.depth_mm * spec.side,
               outer_mm = beyond_mm + k_beyond_mm * spec.side;
  const double top_mm =
      tree.origin_mm().z + static_cast<double>(tree.size().z) * leaf + k_beyond_mm;
  box.size_mm = {std::fabs(outer_mm - axial_mm), spec.width_mm, top_mm - floor_mm};
  box.at_mm = {0.5 * (outer_mm + axial_mm), contact->y, 0.5 * (top_mm + floor_mm)};
  return box;
}

}  // namespace cavum::scenarios
