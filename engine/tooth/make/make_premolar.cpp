#include "engine/tooth/make/make_premolar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "engine/base/text.h"
#include "engine/tooth/make/formula_tooth.h"
#include "engine/tooth/make/tooth_shapes.h"

namespace cavum {
namespace {

constexpr double k_apex_z = -18.2, k_root_top_z = -3.4, k_trunk_bottom_z = -6.0;

constexpr std::array<Knot, 7> k_half_x{
    {{-7.0, 2.35}, {-4.3, 2.55}, {-2.6, 2.95}, {-0.6, 3.4}, {0.9, 3.5}, {2.6, 3.2}, {4.2, 2.5}}};
constexpr std::array<Knot, 7> k_half_y{
    {{-7.0, 3.75}, {-4.3, 4.05}, {-2.8, 4.4}, {-1.4, 4.5}, {0.6, 4.3}, {2.6, 3.75}, {4.3, 2.9}}};
constexpr double k_root_half_x = 2.45, k_root_half_y = 3.95;

/// The two cusps, buccal the higher one.
struct Cusp {
  double x, y, z;
};
constexpr std::array<Cusp, 2> k_cusps{{{0.05, 2.45, 4.25}, {0.3, -2.35, 3.9}}};

double occlusal_height(double x, double y, double slope, double roundness) {
  double h = -10.0;
  for (const auto& c : k_cusps) {
    const double dx = 0.75 * (x - c.x), dy = y - c.y;
    h = smooth_max(
        h, c.z - slope * (std::sqrt(dx * dx + dy * dy + roundness * roundness) - roundness), 0.35);
  }
  for (const double at : {2.75, -2.75}) {
    const double d = segment_distance(x, y, at, -1.5, at, 1.5);
    h = smooth_max(h, 2.75 - slope * (std::sqrt(d * d + 0.25) - 0.5), 0.35);
  }
  return h;
}

/// One central fissure between a mesial and a distal pit.
double fissure_depth(double x, double y) {
  return 0.45 * bell(segment_distance(x, y, 1.5, 0.05, -1.45, 0.05), 0.22);
}

constexpr std::array<Knot, 7> k_pulp_half_x{{{-17.2, 0.15},
                                             {-12.0, 0.27},
                                             {-8.0, 0.40},
                                             {-6.0, 0.50},
                                             {-5.0, 0.62},
                                             {-3.6, 0.80},
                                             {-1.5, 0.78}}};
constexpr std::array<Knot, 7> k_pulp_half_y{{{-17.2, 0.17},
                                             {-12.0, 0.45},
                                             {-8.0, 0.85},
                                             {-6.0, 1.25},
                                             {-5.0, 1.75},
                                             {-3.6, 2.20},
                                             {-1.5, 2.25}}};

}  // namespace

double Premolar::neck_mm(double x, double y) noexcept {
  const double u = x / 2.6, v = y / 4.1, u2 = u * u, v2 = v * v,
               mesiodistal = u2 / (u2 + v2 + 1e-3);
  return -4.2 + 0.9 * mesiodistal * mesiodistal;
}

double Premolar::outside(Vec3 p) const noexcept {
  const double wall = tube(p.x, p.y, profile(k_half_x, p.z), profile(k_half_y, p.z));
  const double top = (p.z - occlusal_height(p.x, p.y, 0.66, 0.8) + fissure_depth(p.x, p.y)) * 0.84;
  const double trunk = smooth_max(smooth_max(wall, top, 0.9), k_trunk_bottom_z - p.z, 1.2);
  const double root =
      smooth_max(paraboloid(p, 0.0, k_root_half_x, k_root_half_y, k_apex_z, k_root_top_z),
                 p.z - k_root_top_z, 0.6);
  return smooth_min(trunk, root, 0.7);
}

double Premolar::core(Vec3 p) const noexcept {
  const double u = std::clamp((p.z - neck_mm(p.x, p.y)) / 4.2, 0.0, 1.0);
  const double lateral = shape_.lateral_enamel_mm * (1 - (1 - u) * (1 - u));
  const double wall =
      tube(p.x, p.y, profile(k_half_x, p.z) - lateral, profile(k_half_y, p.z) - lateral);
  const double top = (p.z - occlusal_height(p.x * 1.07, p.y * 1.07, 0.56, 0.85) +
                      shape_.occlusal_enamel_mm + 0.30) *
                     0.86;
  return smooth_max(wall, top, 0.8);
}

double Premolar::pulp(Vec3 p) const noexcept {
  const double roof = shape_.chamber_roof_mm, end = k_apex_z + 1.0;
  const double wall = tube(p.x, p.y, profile(k_pulp_half_x, p.z), profile(k_pulp_half_y, p.z));
  double d = smooth_max(wall, std::max(p.z - roof, end - p.z), 0.3);
  d = smooth_min(d, round_cone(p, {0, 1.45, roof - 0.5}, 0.45, {0, 1.95, roof + 1.25}, 0.14), 0.3);
  return smooth_min(d, round_cone(p, {0, -1.45, roof - 0.5}, 0.45, {0, -1.85, roof + 0.85}, 0.14),
                    0.3);
}

Tooth make_premolar(const PremolarShape& shape) {
  check_choice("--occlusal-enamel-mm", shape.occlusal_enamel_mm, 1.2, 2.2);
  check_choice("--lateral-enamel-mm", shape.lateral_enamel_mm, 0.9, 1.6);
  check_choice("--chamber-roof-mm", shape.chamber_roof_mm, -3.0, -1.2);
  return build_formula_tooth(Premolar(shape), {{-3.7, -4.7, k_apex_z - 0.1}, {3.7, 4.7, 4.4}},
                             shape.leaf_mm, shape.periodontium_mm,
                             noop("upper second premolar (parametric, one canal)"),
                             {ToothDesign::premolar});
}

}  // namespace cavum
