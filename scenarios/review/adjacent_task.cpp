#include "scenarios/review/adjacent_task.h"

#include <algorithm>

#include "engine/tooth/adjacent.h"
#include "engine/tooth/anatomy/polylines.h"
#include "engine/tooth/octree_edit.h"

namespace cavum::scenarios {
namespace {

// Clearance of 0.5 mm, a tine of an explorer, is what guides ask for; 0.3 where curved surfaces
// leave no more (docs/neighbour.md).
constexpr double k_wanted_gap_mm = 0.35;  // along x: the straight distance is a little less
constexpr double k_step_mm = 0.1;

/// From the tooth's surface to the neighbour's along x in a row of leaves, mm; large where one of
/// them is not there.
double distance_to_neighbour_mm(const Tooth& tooth, const TissueSet& neighbours,
                                const TissueSet& beside, int side, double y_mm, double z_mm) {
  constexpr double k_none_mm = 1e3;
  const Octree& tree = tooth.octree;
  const IVec3 at = tree.leaf_at({tree.origin_mm().x, y_mm, z_mm});
  const int n = tree.size().x;
  int own = -1, other = -1;
  for (int x = side > 0 ? 0 : n - 1; x >= 0 && x < n; x += side) {
    const std::uint8_t t = tree.tissue({x, at.y, at.z});
    if (!tree.is_solid(t)) continue;
    if (neighbours[t] && own >= 0) {
      other = x;
      break;
    }
    if (!beside[t]) own = x;
  }
  return own < 0 || other < 0 ? k_none_mm : (side * (other - own) - 1) * tree.leaf_mm();
}

}  // namespace

bool neighbour_stands(const Tooth& tooth, int side) {
  const TissueSet neighbours = tissues_of(tooth, TissueKind::neighbour),
                  beside = adjacent_tissues(tooth);
  const Octree& tree = tooth.octree;
  double middle = 0, leaves = 0;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (!tree.is_solid(t) || beside[t]) return;
    const double n = static_cast<double>(edge) * edge * edge;
    middle += n * (at.x + 0.5 * edge);
    leaves += n;
  });
  bool there = false;
  tree.for_each_cube([&](IVec3 at, int, std::uint8_t t) {
    there = there || (neighbours[t] && side * (at.x * leaves - middle) > 0);
  });
  return there;
}

ContactBox box_beside(const Tooth& tooth, const Landmarks& landmarks, int side, ContactBox box,
                      double least_above_neck_mm, double widest_mm) {
  const Vec3 *contact = furthest_along(landmarks.height_of_contour_mm, Vec3{1.0 * side, 0, 0}),
             *neck = furthest_along(landmarks.neck_mm, Vec3{1.0 * side, 0, 0});
  if (contact == nullptr || neck == nullptr || !neighbour_stands(tooth, side)) return box;
  box.shell = true;
  const TissueSet neighbours = tissues_of(tooth, TissueKind::neighbour),
                  beside = adjacent_tissues(tooth);
  const double half_leaf = 0.5 * tooth.octree.leaf_mm();
  // the floor's margin is as near as its nearest place
  const auto floor_gap = [&](double above) {
    double least = 1e3;
    for (double y = -0.5 * box.width_mm; y <= 0.5 * box.width_mm; y += k_step_mm)
      least =
          std::min(least, distance_to_neighbour_mm(tooth, neighbours, beside, side, contact->y + y,
                                                   neck->z + above - half_leaf));
    return least;
  };
  while (box.above_neck_mm - k_step_mm >= least_above_neck_mm &&
         floor_gap(box.above_neck_mm) < k_wanted_gap_mm)
    box.above_neck_mm -= k_step_mm;
  const auto side_gap = [&](double width) {
    double least = 1e3;
    for (double z = neck->z + box.above_neck_mm; z <= contact->z + 1.0; z += k_step_mm)
      for (const int sign : {1, -1})
        least = std::min(
            least, distance_to_neighbour_mm(tooth, neighbours, beside, side,
                                            contact->y + sign * (0.5 * width + half_leaf), z));
    return least;
  };
  while (box.width_mm + 2 * k_step_mm <= widest_mm && side_gap(box.width_mm) < k_wanted_gap_mm)
    box.width_mm += 2 * k_step_mm;
  return box;
}

std::vector<std::string> adjacent_criteria(const Tooth& tooth, int opens) {
  const auto counts = tooth.octree.count_leaves();
  const auto any_of = [&](const TissueSet& set) {
    for (std::size_t t = 0; t < set.size(); ++t)
      if (set[t] && counts[t] > 0) return true;
    return false;
  };
  std::vector<std::string> names;
  if (any_of(tissues_of(tooth, TissueKind::neighbour))) names.emplace_back("neighbour_criterion");
  if (opens != 0 && neighbour_stands(tooth, opens)) names.emplace_back("clearance_criterion");
  if (any_of(tissues_of(tooth, TissueKind::gum))) names.emplace_back("gum_criterion");
  return names;
}

}  // namespace cavum::scenarios
