#include "engine/tooth/make/make_incisor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "engine/base/text.h"
#include "engine/tooth/make/formula_tooth.h"
#include "engine/tooth/make/tooth_shapes.h"

namespace cavum {
namespace {

constexpr double k_edge_z = 5.25, k_apex_z = -18.25, k_root_top_z = -4.2, k_trunk_bottom_z = -7.0;

/// Half width, and where the labial and the lingual face stand, by height: the cingulum bulges low
/// on the lingual side, above it the face is hollow.
constexpr std::array<Knot, 6> k_half_x{
    {{-8.0, 3.1}, {-5.2, 3.45}, {-3.0, 3.75}, {0.0, 4.1}, {3.0, 4.25}, {5.3, 4.05}}};
constexpr std::array<Knot, 7> k_labial{
    {{-8.0, 2.75}, {-5.2, 3.0}, {-3.5, 3.35}, {-1.5, 3.4}, {1.0, 3.05}, {3.0, 2.4}, {5.3, 1.4}}};
constexpr std::array<Knot, 8> k_lingual{{{-8.0, -2.75},
                                         {-5.2, -3.0},
                                         {-3.8, -3.5},
                                         {-2.0, -2.95},
                                         {0.0, -1.75},
                                         {2.0, -0.75},
                                         {4.0, 0.05},
                                         {5.3, 0.35}}};
constexpr double k_root_half_x = 3.35, k_root_half_y = 2.95;

constexpr std::array<Knot, 7> k_pulp_half_x{{{-17.2, 0.16},
                                             {-12.0, 0.40},
                                             {-8.0, 0.72},
                                             {-5.0, 1.05},
                                             {-2.0, 1.35},
                                             {0.4, 1.55},
                                             {1.6, 1.5}}};
constexpr std::array<Knot, 7> k_pulp_half_y{{{-17.2, 0.16},
                                             {-12.0, 0.40},
                                             {-8.0, 0.72},
                                             {-5.0, 0.95},
                                             {-2.5, 0.75},
                                             {0.4, 0.42},
                                             {1.6, 0.32}}};

double middle_y(double z) { return 0.5 * (profile(k_labial, z) + profile(k_lingual, z)); }
double half_y(double z) { return 0.5 * (profile(k_labial, z) - profile(k_lingual, z)); }

}  // namespace

double Incisor::neck_mm(double x, double y) noexcept {
  const double u = x / 3.45, v = y / 3.0, u2 = u * u, v2 = v * v,
               mesiodistal = u2 / (u2 + v2 + 1e-3);
  return -5.25 + (x > 0 ? 3.5 : 2.5) * mesiodistal * mesiodistal;
}

double Incisor::outside(Vec3 p) const noexcept {
  const double wall = tube(p.x, p.y - middle_y(p.z), profile(k_half_x, p.z), half_y(p.z));
  const double edge =
      k_edge_z - 0.03 * p.x * p.x + 0.04 * p.x;  // the distal corner is the rounder one
  const double crown = smooth_max(wall, (p.z - edge) * 0.96, 0.5);
  const double trunk = smooth_max(crown, k_trunk_bottom_z - p.z, 1.2);
  const double root =
      smooth_max(paraboloid(p, 0.0, k_root_half_x, k_root_half_y, k_apex_z, k_root_top_z),
                 p.z - k_root_top_z, 0.6);
  return smooth_min(trunk, root, 0.7);
}

double Incisor::core(Vec3 p) const noexcept {
  const double u = std::clamp((p.z - neck_mm(p.x, p.y)) / 4.0, 0.0, 1.0);
  const double lateral = shape_.lateral_enamel_mm * (1 - (1 - u) * (1 - u));
  // Towards the edge the dentin ends in a thin ridge.
  const double wall = tube(p.x, p.y - middle_y(p.z), profile(k_half_x, p.z) - 1.15 * lateral,
                           std::max(half_y(p.z) - lateral, 0.2));
  return smooth_max(wall, (p.z - (k_edge_z - shape_.incisal_enamel_mm)) * 0.96, 0.4);
}

double Incisor::pulp(Vec3 p) const noexcept {
  const double top = shape_.chamber_top_mm, end = k_apex_z + 1.0;
  const double wall =
      tube(p.x, p.y - middle_y(p.z), profile(k_pulp_half_x, p.z), profile(k_pulp_half_y, p.z));
  double d = smooth_max(wall, std::max(p.z - top, end - p.z), 0.3);
  for (const double side : {1.0, -1.0})
    d = smooth_min(d,
                   round_cone(p, {side * 1.0, middle_y(top - 0.6), top - 0.6}, 0.26,
                              {side * 1.3, middle_y(top + 0.7), top + 0.7}, 0.1),
                   0.25);
  return d;
}

Tooth make_incisor(const IncisorShape& shape) {
  check_choice("--incisal-enamel-mm", shape.incisal_enamel_mm, 1.0, 2.0);
  check_choice("--lateral-enamel-mm", shape.lateral_enamel_mm, 0.5, 1.0);
  check_choice("--chamber-top-mm", shape.chamber_top_mm, -1.0, 2.0);
  return build_formula_tooth(
      Incisor(shape), {{-4.4, -3.7, k_apex_z - 0.1}, {4.4, 3.6, k_edge_z + 0.1}}, shape.leaf_mm,
      shape.periodontium_mm, noop("upper central incisor (parametric, one canal)"),
      {ToothDesign::incisor});
}

}  // namespace cavum
