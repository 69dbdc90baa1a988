#include "engine/tooth/make/make_molar.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "engine/tooth/make/formula_tooth.h"
#include "engine/tooth/make/tooth_shapes.h"

namespace cavum {
namespace {

// ---- the crown ----

/// Half widths of crown and trunk by height. The widest place (height of contour) lies a little
/// above the middle on the mesial and distal side, lower on the buccal and lingual side.
constexpr std::array<Knot, 8> k_half_x{{{-9.5, 4.35},
                                        {-7.0, 4.3},
                                        {-5.0, 4.3},
                                        {-3.4, 4.55},
                                        {-1.6, 5.1},
                                        {0.4, 5.5},
                                        {2.0, 5.25},
                                        {3.6, 4.4}}};
constexpr std::array<Knot, 8> k_half_y{{{-9.5, 4.0},
                                        {-7.0, 4.1},
                                        {-5.0, 4.3},
                                        {-3.4, 4.6},
                                        {-2.0, 4.95},
                                        {-0.6, 5.0},
                                        {1.6, 4.55},
                                        {3.6, 3.7}}};

/// A cusp: its tip and how far it reaches. Lingual cusps are the higher ones, the distal cusp the
/// smallest.
struct Cusp {
  double x, y, z;
};
constexpr std::array<Cusp, 5> k_cusps{{{2.55, 2.85, 3.25},
                                       {-0.95, 3.05, 3.05},
                                       {-3.7, 1.75, 2.55},
                                       {2.5, -2.75, 3.5},
                                       {-2.0, -2.8, 3.35}}};

/// Height of the occlusal face, without fissures: rounded cones under the cusps and the two
/// marginal ridges.
double occlusal_height(double x, double y, double slope, double roundness) {
  double h = -10.0;
  for (const auto& c : k_cusps) {
    const double dx = x - c.x, dy = y - c.y;
    h = smooth_max(
        h, c.z - slope * (std::sqrt(dx * dx + dy * dy + roundness * roundness) - roundness), 0.35);
  }
  const auto ridge = [&](double at) {
    const double d = segment_distance(x, y, at, -1.6, at, 1.6);
    h = smooth_max(h, 2.1 - slope * (std::sqrt(d * d + 0.25) - 0.5), 0.35);
  };
  ridge(4.55);
  ridge(-4.6);
  return h;
}

/// Depth of the fissures: a central one with a mesial and a distal pit, and arms between the cusps.
double fissure_depth(double x, double y) {
  const double main = std::min({segment_distance(x, y, 3.1, 0.05, 0.7, 0.2),
                                segment_distance(x, y, 0.7, 0.2, -1.2, -0.25),
                                segment_distance(x, y, -1.2, -0.25, -3.3, -0.3)});
  const double arms = std::min({segment_distance(x, y, 0.7, 0.2, 0.95, 2.6),
                                segment_distance(x, y, -1.5, -0.2, -2.75, 2.0),
                                segment_distance(x, y, 0.2, 0.0, 0.25, -2.6)});
  return 0.42 * bell(main, 0.22) + 0.25 * bell(arms, 0.24);
}

// ---- the roots ----

constexpr double k_apex_z = -16.4, k_root_top_z = -5.0, k_trunk_bottom_z = -7.25;

/// Height above the apex as a share of the root, 0 at the apex, 1 at the top.
double along_root(double z) { return (z - k_apex_z) / (k_root_top_z - k_apex_z); }
/// x of the root's axis: the roots spread, then bend distally, the mesial one more.
double mesial_axis_x(double z) {
  const double s = 1 - along_root(z);
  return 2.2 + 1.9 * s - 2.1 * s * s;
}
double distal_axis_x(double z) {
  const double s = 1 - along_root(z);
  return -2.35 - 1.5 * s + 0.75 * s * s;
}
constexpr double k_mesial_half_x = 2.0, k_mesial_half_y = 4.1, k_distal_half_x = 2.0,
                 k_distal_half_y = 3.6;

// ---- the pulp ----

struct Canal {
  bool mesial;
  double y;             // at the orifice; canals of one root draw together towards the apex
  double orifice, end;  // radii
};

/// One canal, along its root's axis from the chamber's floor to 1 mm above the apex.
double canal_distance(Vec3 p, const Canal& c, double floor_z) {
  constexpr int k_parts = 8;
  const double end_z = k_apex_z + 1.0;
  double d = 1e9;
  Vec3 before;
  double before_r = 0.0;
  for (int i = 0; i <= k_parts; ++i) {
    const double t = static_cast<double>(i) / k_parts;
    const double z = floor_z + 0.15 + t * (end_z - floor_z - 0.15);
    const double axis = c.mesial ? mesial_axis_x(z) : distal_axis_x(z);
    // The orifice lies nearer to the tooth's middle than the root's axis.
    const double x = axis + (c.mesial ? -0.35 : 0.35) * (1 - t) * (1 - t);
    const Vec3 here{x, c.y * (1 - 0.62 * t), z};
    const double r = c.orifice + (c.end - c.orifice) * t * (1.6 - 0.6 * t);
    if (i > 0) d = std::min(d, round_cone(p, before, before_r, here, r));
    before = here;
    before_r = r;
  }
  return d;
}

std::span<const Canal> canals_of(int count) {
  static constexpr std::array<Canal, 2> two{{{true, 0.0, 0.42, 0.16}, {false, 0.0, 0.45, 0.17}}};
  static constexpr std::array<Canal, 3> three{
      {{true, 1.45, 0.34, 0.14}, {true, -1.4, 0.34, 0.14}, {false, 0.0, 0.46, 0.17}}};
  static constexpr std::array<Canal, 4> four{{{true, 1.45, 0.33, 0.14},
                                              {true, -1.4, 0.33, 0.14},
                                              {false, 1.15, 0.34, 0.15},
                                              {false, -1.15, 0.34, 0.15}}};
  if (count == 2) return two;
  if (count == 4) return four;
  return three;
}

}  // namespace

double Molar::neck_mm(double x, double y) noexcept {
  const double u = x / 4.5, v = y / 4.6, u2 = u * u, v2 = v * v;
  const double mesiodistal = u2 / (u2 + v2 + 1e-3);
  return -3.55 + 0.95 * mesiodistal * mesiodistal;
}

double Molar::crown(Vec3 p) const noexcept {
  double half_y = profile(k_half_y, p.z);
  // Buccal and lingual grooves run down the walls between the cusps.
  const double high = ramp(-1.2, 2.0, p.z);
  half_y -= p.y > 0 ? 0.30 * high * (bell(p.x - 1.0, 0.55) + 0.7 * bell(p.x + 2.9, 0.5))
                    : 0.28 * high * bell(p.x - 0.25, 0.55);
  const double wall = tube(p.x, p.y, profile(k_half_x, p.z), half_y);
  const double top = (p.z - occlusal_height(p.x, p.y, 0.60, 0.75) + fissure_depth(p.x, p.y)) * 0.86;
  return smooth_max(wall, top, 0.9);
}

double Molar::roots(Vec3 p) const noexcept {
  const double mesial =
      paraboloid(p, mesial_axis_x(p.z), k_mesial_half_x, k_mesial_half_y, k_apex_z, k_root_top_z);
  const double distal =
      paraboloid(p, distal_axis_x(p.z), k_distal_half_x, k_distal_half_y, k_apex_z, k_root_top_z);
  return smooth_max(smooth_min(mesial, distal, 0.5), p.z - k_root_top_z - 0.8, 0.6);
}

double Molar::outside(Vec3 p) const noexcept {
  const double trunk = smooth_max(crown(p), k_trunk_bottom_z - p.z, 1.2);
  return smooth_min(trunk, roots(p), 0.7);
}

double Molar::core(Vec3 p) const noexcept {
  // Thickness of the walls' enamel: none at the neck, rising to its full value 4.2 mm above it.
  const double u = std::clamp((p.z - neck_mm(p.x, p.y)) / 4.2, 0.0, 1.0);
  const double lateral = shape_.lateral_enamel_mm * (1 - (1 - u) * (1 - u));
  const double wall =
      tube(p.x, p.y, profile(k_half_x, p.z) - lateral, profile(k_half_y, p.z) - lateral);
  // Dentin has cusps of its own, lower and rounder.
  const double top = (p.z - occlusal_height(p.x * 1.07, p.y * 1.07, 0.53, 0.8) +
                      shape_.occlusal_enamel_mm + 0.32) *
                     0.87;
  return smooth_max(wall, top, 0.8);
}

double Molar::pulp(Vec3 p) const noexcept {
  const double roof = shape_.chamber_roof_mm, floor = roof - shape_.chamber_height_mm;
  const double widen = 0.12 * (p.z - floor);  // the chamber is a little wider at its roof
  const double wall = tube(p.x - 0.1, p.y, 2.2 + widen, 1.7 + widen);
  const double dome =
      roof + 0.05 * std::sqrt(p.x * p.x + p.y * p.y + 0.04);  // the roof hangs down in its middle
  double d = smooth_max(wall, std::max(p.z - dome, floor - p.z), 0.35);
  for (const auto& c : k_cusps) {
    const double high = c.z > 2.8 ? roof + 1.15 + 0.5 * (c.z - 3.0) : roof + 0.6;
    d = smooth_min(d,
                   round_cone(p, {c.x * 0.62, c.y * 0.45, roof - 0.35}, 0.42,
                              {c.x * 0.74, c.y * 0.60, high}, 0.13),
                   0.3);
  }
  double canals = 1e9;
  for (const auto& c : canals_of(shape_.canals))
    canals = std::min(canals, canal_distance(p, c, floor));
  return smooth_min(d, canals, 0.25);
}

Tooth make_molar(const MolarShape& shape) {
  check_choice("--canals", shape.canals, 2, 4);
  check_choice("--occlusal-enamel-mm", shape.occlusal_enamel_mm, 1.2, 2.2);
  check_choice("--lateral-enamel-mm", shape.lateral_enamel_mm, 1.0, 2.0);
  check_choice("--chamber-roof-mm", shape.chamber_roof_mm, -3.2, -1.8);
  check_choice("--chamber-height-mm", shape.chamber_height_mm, 1.0, 2.2);
  return build_formula_tooth(Molar(shape), {{-5.7, -5.3, k_apex_z - 0.1}, {5.7, 5.3, 3.7}},
                             shape.leaf_mm, shape.periodontium_mm,
                             fmt::format("lower first molar (parametric, {} canals)", shape.canals),
                             {ToothDesign::molar});
}

}  // namespace cavum
