#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/tooth/make/grow_teeth.h"
#include "engine/tooth/make/grown_tooth.h"
#include "engine/tooth/make/individual.h"

namespace cavum {
namespace {

// Means, deviations and ranges with their sources: docs/teeth.md. mm; heights over the buccal
// cervical line.
constexpr Published k_crown_length{11.13, 0.4, 10.3, 11.95}, k_crown_width{10.3, 0.35, 9.6, 11.0},
    k_crown_height{7.45, 0.3, 6.85, 8.1};
constexpr Published k_neck_length{9.2, 0.35, 8.5, 9.9}, k_neck_width{9.0, 0.35, 8.3, 9.7};
constexpr Published k_mesial_curve{0.8, 0.2, 0.4, 1.2}, k_distal_curve{0.4, 0.15, 0.1, 0.7},
    k_lingual_rise{0.4, 0.1, 0.2, 0.6};
constexpr Published k_root{14.0, 0.8, 12.4, 15.6}, k_trunk{5.6, 0.25, 5.1, 6.1};
constexpr Published k_cusp_enamel{1.65, 0.1, 1.45, 1.85}, k_valley_enamel{1.0, 0.06, 0.88, 1.12},
    k_wall_enamel{1.3, 0.08, 1.14, 1.46};
constexpr Published k_fissure{0.5, 0.05, 0.4, 0.6}, k_pit{0.2, 0.03, 0.14, 0.26};
// Narrower than the published deviations (0.93 and 0.68): individuals shall be of about equal
// difficulty.
constexpr Published k_cusp_to_roof{6.45, 0.2, 6.05, 6.85}, k_chamber_height{1.6, 0.2, 1.25, 2.0};
constexpr Published k_mesial_mouths{2.3, 0.25, 1.8, 2.8};

struct MolarMeasures {
  double length, width, height, neck_length, neck_width;
};

WallPlan molar_wall(const MolarMeasures& m) {
  const double h = m.height, neck_x = 0.5 * m.neck_length, neck_y = 0.5 * m.neck_width,
               x = 0.5 * m.length, y = 0.5 * m.width;
  WallPlan w;
  w.mesial = {{-6.0, neck_x - 0.35}, {-2.0, neck_x - 0.2}, {0.9, neck_x}, {0.42 * h, x - 0.2},
              {0.66 * h, x},         {0.84 * h, x - 0.3},  {h, x - 1.0}};
  w.distal = {{-6.0, neck_x - 0.35}, {-2.0, neck_x - 0.2}, {0.7, neck_x}, {0.36 * h, x - 0.25},
              {0.60 * h, x},         {0.80 * h, x - 0.4},  {h, x - 1.4}};
  // Buccally the greatest width lies low, in the cervical third; the crown leans lingually.
  w.buccal = {{-6.0, neck_y - 0.4}, {-2.0, neck_y - 0.15},
              {0.0, neck_y},        {0.13 * h, 0.54 * y + 0.46 * neck_y},
              {0.29 * h, y + 0.04}, {0.5 * h, y - 0.2},
              {0.75 * h, y - 0.85}, {h, y - 1.85}};
  w.lingual = {{-6.0, neck_y - 0.4}, {-2.0, neck_y - 0.2}, {0.4, neck_y - 0.05}, {0.3 * h, y - 0.3},
               {0.55 * h, y - 0.1},  {0.8 * h, y - 0.45},  {1.06 * h, y - 1.3}};
  w.squareness = 0.55;
  w.root_squareness = 0.4;
  w.narrow_lingual = 0.05;
  w.narrow_distal = 0.06;
  // The trunk is hollow above the furcation, from the cervical line on.
  w.dents = {{1.0, 0.0, 1.5, 0.85, {-30.0, -29.0, -3.0, 0.6}},
             {-1.0, 0.0, 1.5, 0.8, {-30.0, -29.0, -3.0, 0.8}}};
  return w;
}

/// Five cusps where the textbook draws them, each a little elsewhere in each individual.
std::vector<CuspPlan> molar_cusps(Individual& one, const MolarMeasures& m) {
  struct Usual {
    double x, y, above, in_x, in_y, bend;
  };
  const double excess = one.between(0.25, 0.5);  // the lingual cusps are the higher ones
  const Usual usual[] = {{2.45, 2.75, 0.0, -0.15, -1.0, 0.1},
                         {-1.15, 2.9, -0.15, -0.1, -1.0, -0.1},
                         {-3.65, 1.5, -0.6, 1.0, -0.6, 0.0},
                         {2.3, -3.1, excess, -0.2, 1.0, 0.1},
                         {-2.2, -3.05, excess - 0.15, 0.2, 1.0, -0.1}};
  std::vector<CuspPlan> cusps;
  for (const Usual& u : usual) {
    const double in_x = u.in_x + one.between(-0.12, 0.12),
                 l = std::sqrt(in_x * in_x + u.in_y * u.in_y);
    const Vec3 tip{u.x * m.length / 11.0 + one.between(-0.18, 0.18),
                   u.y * m.width / 10.4 + one.between(-0.09, 0.09),
                   m.height + u.above + (cusps.empty() ? 0.0 : one.between(-0.08, 0.08))};
    cusps.push_back({tip, in_x / l, u.in_y / l, one.between(0.41, 0.47), one.between(0.6, 0.64),
                     one.between(0.74, 0.82), 0.45, u.bend + one.between(-0.06, 0.06)});
    cusps.back().side_groove_mm = one.between(0.03, 0.09);
  }
  return cusps;
}

/// Chamber with a horn below each cusp, and three canals.
PulpPlan molar_pulp(Individual& one, const MolarMeasures& m, const std::vector<CuspPlan>& cusps) {
  PulpPlan q;
  q.roof_z_mm = m.height - one.draw(k_cusp_to_roof, 0.75);
  q.floor_z_mm = q.roof_z_mm - one.draw(k_chamber_height);
  q.middle_x_mm = 0.1;
  q.middle_y_mm = 0.0;
  q.half_x_mm = 0.235 * m.neck_length + one.between(-0.12, 0.12);
  q.half_y_mm = 0.195 * m.neck_width + one.between(-0.1, 0.1);
  q.widen_x = q.widen_y = 0.12;
  q.sag = 0.05;
  for (const CuspPlan& c : cusps) {
    const double up = 1.1 + one.between(-0.2, 0.2) - 0.4 * (m.height - c.tip_mm.z);
    q.horns.push_back({{c.tip_mm.x * 0.56, c.tip_mm.y * 0.36, q.roof_z_mm - 0.6},
                       {c.tip_mm.x * 0.74, c.tip_mm.y * 0.6, q.roof_z_mm + up},
                       0.55,
                       0.12});
  }
  const double apart = 0.5 * one.draw(k_mesial_mouths, 0.4), wide = one.between(0.31, 0.37);
  q.canals = {{0, -0.32, apart, wide, 0.15, 1.6, 0.45},
              {0, -0.32, -apart, wide, 0.15, 1.6, 0.45},
              {1, 0.32, 0.0, one.between(0.38, 0.46), 0.18, 2.0, 0.3}};
  return q;
}

}  // namespace

ToothPlan molar_plan(std::uint64_t seed) {
  Individual one(seed, 1);
  MolarMeasures m{};
  m.length = one.draw(k_crown_length, 0.7);
  m.width = one.draw(k_crown_width, 0.7);
  m.height = one.draw(k_crown_height, 0.75);
  m.neck_length = one.draw(k_neck_length, 0.7);
  m.neck_width = one.draw(k_neck_width, 0.7);
  const double h = m.height, x = m.length / 11.0, y = m.width / 10.4;

  ToothPlan p;
  p.cusps = molar_cusps(one, m);
  double top = 0.0;
  for (const CuspPlan& c : p.cusps) top = std::max(top, c.tip_mm.z);
  p.base_z_mm = -0.5 * top;
  p.crests = {{4.5 * x, 0.04, h - one.between(1.2, 1.45), 0.07, -1.0, 0.75, 0.5, 2.2 * y},
              {-4.6 * x, -0.05, h - one.between(1.4, 1.65), 0.08, 1.0, 0.75, 0.5, 1.8 * y}};
  p.wall_grooves = {{0, 1, one.between(0.28, 0.4), 0.5},
                    {1, 2, one.between(0.24, 0.34), 0.45},
                    {3, 4, one.between(0.22, 0.34), 0.5}};
  p.groove_low_z_mm = 0.22 * h;
  p.groove_high_z_mm = 0.85 * h;
  p.fissures.depth_mm = one.draw(k_fissure);
  p.fissures.pit_mm = one.draw(k_pit);
  p.fissures.at_crests = 0.35;
  p.wall = molar_wall(m);
  p.rooted_z_mm = -one.draw(k_trunk);
  p.neck = {one.draw(k_mesial_curve, 0.3), one.draw(k_distal_curve, 0.3), one.draw(k_lingual_rise),
            0.5 * m.neck_length, 0.5 * m.neck_width};
  const double wall_enamel = one.draw(k_wall_enamel, 0.2);
  p.enamel = {wall_enamel + 0.1,
              wall_enamel - 0.1,
              wall_enamel - 0.1,
              4.0,
              one.draw(k_cusp_enamel, 0.2),
              one.draw(k_valley_enamel, 0.2)};
  const double root = one.draw(k_root, 0.6), bend = one.between(0.6, 1.3);
  const double half_y = 0.5 * m.neck_width - 0.15, half_x = 0.212 * m.neck_length,
               at = 0.25 * m.neck_length;
  p.roots = {{at, 0.5, -root, bend, -1.6 * bend, one.between(-0.2, 0.4), half_x, half_y, 1.5, 0.18},
             {-at, 0.5, -root + one.between(0.3, 1.0), -one.between(0.8, 1.6),
              one.between(0.2, 0.8), one.between(-0.2, 0.4), half_x, half_y - 0.15, 1.4, 0.1}};
  p.pulp = molar_pulp(one, m, p.cusps);
  return p;
}

Tooth grow_molar(const SeedTooth& what) {
  const GrownTooth shape(molar_plan(what.seed));
  return grow_tooth(shape, what.leaf_mm, what.periodontium_mm,
                    fmt::format("lower first molar (seed {}, 3 canals)", what.seed),
                    {ToothDesign::molar, what.seed});
}

}  // namespace cavum
