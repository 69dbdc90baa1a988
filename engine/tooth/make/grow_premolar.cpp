#include <fmt/core.h>

#include <cmath>

#include "engine/tooth/make/grow_teeth.h"
#include "engine/tooth/make/grown_tooth.h"
#include "engine/tooth/make/individual.h"

namespace cavum {
namespace {

// Means, deviations and ranges with their sources: docs/teeth.md. mm; heights over the buccal
// cervical line.
constexpr Published k_crown_length{6.7, 0.3, 6.1, 7.3}, k_crown_width{9.2, 0.4, 8.4, 10.0},
    k_crown_height{7.8, 0.4, 7.1, 8.6};
constexpr Published k_neck_length{4.8, 0.2, 4.4, 5.3}, k_neck_width{8.1, 0.3, 7.5, 8.7};
constexpr Published k_mesial_curve{0.9, 0.2, 0.5, 1.3}, k_distal_curve{0.6, 0.15, 0.3, 0.9};
constexpr Published k_root{14.0, 0.9, 12.2, 15.8};
constexpr Published k_cusp_enamel{1.6, 0.1, 1.4, 1.8}, k_valley_enamel{1.0, 0.06, 0.88, 1.12},
    k_wall_enamel{1.2, 0.1, 1.0, 1.4};
constexpr Published k_fissure{0.5, 0.05, 0.4, 0.6}, k_pit{0.2, 0.03, 0.14, 0.26};
constexpr Published k_tip_to_roof{
    6.75, 0.2, 6.35, 7.15};  // narrow, so that individuals are of about equal difficulty

struct PremolarMeasures {
  double length, width, height, neck_length, neck_width;
};

WallPlan premolar_wall(const PremolarMeasures& m) {
  const double h = m.height, neck_x = 0.5 * m.neck_length, neck_y = 0.5 * m.neck_width,
               x = 0.5 * m.length, y = 0.5 * m.width;
  WallPlan w;
  w.mesial = {{-6.0, neck_x - 0.25}, {-2.0, neck_x - 0.1}, {0.9, neck_x}, {0.42 * h, x - 0.2},
              {0.62 * h, x},         {0.82 * h, x - 0.3},  {h, x - 0.9}};
  w.distal = {{-6.0, neck_x - 0.25}, {-2.0, neck_x - 0.1}, {0.4, neck_x}, {0.38 * h, x - 0.2},
              {0.58 * h, x},         {0.78 * h, x - 0.3},  {h, x - 1.0}};
  w.buccal = {
      {-6.0, neck_y - 0.3}, {-2.0, neck_y - 0.1}, {0.0, neck_y}, {0.14 * h, 0.5 * (y + neck_y)},
      {0.31 * h, y},        {0.6 * h, y - 0.4},   {h, y - 1.45}};
  w.lingual = {{-6.0, neck_y - 0.3}, {-2.0, neck_y - 0.1}, {0.0, neck_y - 0.05},
               {0.25 * h, y - 0.3},  {0.5 * h, y},         {0.75 * h, y - 0.4},
               {h, y - 1.35}};
  w.squareness = 0.3;
  w.narrow_lingual = 0.06;
  return w;
}

/// Two cusps, the buccal one higher; the lingual tip lies mesially.
std::vector<CuspPlan> premolar_cusps(Individual& one, const PremolarMeasures& m) {
  const double x = m.length / 6.7, y = m.width / 9.3;
  std::vector<CuspPlan> cusps;
  for (const double side : {1.0, -1.0}) {
    const double in_x = one.between(-0.15, 0.15), l = std::sqrt(in_x * in_x + 1);
    const Vec3 tip{(side > 0 ? -0.1 : 0.35) * x + one.between(-0.15, 0.15),
                   side * 2.75 * y + one.between(-0.1, 0.1),
                   m.height - (side > 0 ? 0.0 : one.between(0.2, 0.5))};
    cusps.push_back({tip, in_x / l, -side / l, one.between(0.46, 0.54), one.between(0.64, 0.72),
                     one.between(0.76, 0.86), 0.5,
                     one.between(0.05, 0.13) * (one.between(0, 1) < 0.5 ? -1.0 : 1.0)});
    cusps.back().cusp_ridge_bow = 0.13;
    cusps.back().side_groove_mm = one.between(0.04, 0.09);
  }
  return cusps;
}

PulpPlan premolar_pulp(Individual& one, const PremolarMeasures& m,
                       const std::vector<CuspPlan>& cusps) {
  PulpPlan q;
  q.roof_z_mm = m.height - one.draw(k_tip_to_roof, 0.75);
  q.floor_z_mm = -one.between(1.0, 1.6);
  q.middle_x_mm = 0.0;
  q.middle_y_mm = 0.0;
  q.half_x_mm = one.between(0.65, 0.85);
  q.half_y_mm = 0.215 * m.neck_width + one.between(-0.1, 0.1);
  q.widen_x = 0.1;  // a funnel into the canal
  q.widen_y = 0.3;
  q.sag = 0.05;
  for (const CuspPlan& c : cusps) {
    const double side = c.tip_mm.y > 0 ? 1.0 : -1.0,
                 up = (side > 0 ? 1.15 : 0.85) + one.between(-0.15, 0.15);
    q.horns.push_back({{0.0, side * (q.half_y_mm - 0.35), q.roof_z_mm - 0.6},
                       {0.3 * c.tip_mm.x, side * (q.half_y_mm + 0.15), q.roof_z_mm + up},
                       0.5,
                       0.12});
  }
  q.canals = {{0, 0.0, 0.0, one.between(0.44, 0.54), 0.2, 2.6, 0.0}};
  return q;
}

}  // namespace

ToothPlan premolar_plan(std::uint64_t seed) {
  Individual one(seed, 2);
  PremolarMeasures m{};
  m.length = one.draw(k_crown_length, 0.7);
  m.width = one.draw(k_crown_width, 0.7);
  m.height = one.draw(k_crown_height, 0.75);
  m.neck_length = one.draw(k_neck_length, 0.7);
  m.neck_width = one.draw(k_neck_width, 0.7);
  const double h = m.height, x = m.length / 6.7, y = m.width / 9.3;

  ToothPlan p;
  p.base_z_mm = -0.5 * h;
  p.cusps = premolar_cusps(one, m);
  p.crests = {{2.65 * x, 0.08, h - one.between(1.45, 1.7), 0.08, -1.0, 0.65, 0.45, 1.9 * y},
              {-2.65 * x, -0.08, h - one.between(1.5, 1.8), 0.08, 1.0, 0.65, 0.45, 1.9 * y}};
  p.groove_low_z_mm = 0.3 * h;
  p.groove_high_z_mm = 0.85 * h;
  p.fissures.depth_mm = one.draw(k_fissure);
  p.fissures.pit_mm = one.draw(k_pit);
  p.fissures.at_crests = 0.25;
  p.fissures.reach_x_mm = 2.3;
  p.fissures.reach_y_mm = 2.2;
  p.wall = premolar_wall(m);
  p.edge_round_mm = 0.7;
  p.neck = {one.draw(k_mesial_curve, 0.3), one.draw(k_distal_curve, 0.3), 0.1, 0.5 * m.neck_length,
            0.5 * m.neck_width};
  const double wall_enamel = one.draw(k_wall_enamel, 0.2);
  p.enamel = {wall_enamel + 0.05,           wall_enamel,
              wall_enamel + 0.05,           4.0,
              one.draw(k_cusp_enamel, 0.2), one.draw(k_valley_enamel, 0.2)};
  const double root = one.draw(k_root, 0.6);
  p.roots = {{0.0, 0.5, -root, one.between(-0.2, 0.2), -one.between(0.2, 0.9),
              one.between(-0.2, 0.4), 0.515 * m.neck_length, 0.515 * m.neck_width, 1.35,
              one.between(0.14, 0.24)}};
  p.pulp = premolar_pulp(one, m, p.cusps);
  return p;
}

Tooth grow_premolar(const SeedTooth& what) {
  const GrownTooth shape(premolar_plan(what.seed));
  return grow_tooth(shape, what.leaf_mm, what.periodontium_mm,
                    fmt::format("upper second premolar (seed {}, one canal)", what.seed),
                    {ToothDesign::premolar, what.seed});
}

}  // namespace cavum
