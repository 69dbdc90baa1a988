#include <fmt/core.h>

#include <algorithm>

#include "engine/tooth/make/grow_teeth.h"
#include "engine/tooth/make/grown_tooth.h"
#include "engine/tooth/make/individual.h"

namespace cavum {
namespace {

// Means, deviations and ranges with their sources: docs/teeth.md. mm; heights over the labial
// cervical line.
constexpr Published k_crown_length{8.6, 0.4, 7.8, 9.4}, k_crown_width{7.1, 0.3, 6.5, 7.7},
    k_crown_height{10.7, 0.5, 9.8, 11.7};
constexpr Published k_neck_length{6.6, 0.25, 6.1, 7.2}, k_neck_width{6.3, 0.25, 5.8, 6.8};
constexpr Published k_mesial_curve{3.0, 0.3, 2.4, 3.6}, k_distal_curve{2.3, 0.3, 1.7, 2.9};
constexpr Published k_root{13.0, 0.9, 11.2, 14.8};
constexpr Published k_edge_enamel{1.3, 0.1, 1.1, 1.5}, k_wall_enamel{0.9, 0.07, 0.75, 1.05};
constexpr Published k_chamber_top{0.42, 0.025, 0.37,
                                  0.47};  // share of the crown's height; narrow, so that
                                          // individuals are of about equal difficulty

struct IncisorMeasures {
  double length, width, height, neck_length, neck_width;
};

WallPlan incisor_wall(Individual& one, const IncisorMeasures& m) {
  const double h = m.height, neck_x = 0.5 * m.neck_length, neck_y = 0.5 * m.neck_width,
               x = 0.5 * m.length, y = 0.5 * m.width;
  WallPlan w;
  w.mesial = {{-6.0, neck_x - 0.3}, {-2.0, neck_x - 0.1}, {0.25 * h, neck_x},
              {0.5 * h, x - 0.45},  {0.85 * h, x},        {1.0 * h, x - 0.15}};
  w.distal = {{-6.0, neck_x - 0.3}, {-2.0, neck_x - 0.1}, {0.2 * h, neck_x},  {0.45 * h, x - 0.4},
              {0.74 * h, x},        {0.93 * h, x - 0.3},  {1.02 * h, x - 0.8}};
  w.buccal = {{-6.0, neck_y - 0.2}, {-2.0, neck_y - 0.1}, {0.0, neck_y},      {0.16 * h, y},
              {0.4 * h, y - 0.3},   {0.7 * h, y - 0.95},  {1.0 * h, y - 2.15}};
  w.lingual = {{-6.0, neck_y - 0.2}, {-2.0, neck_y - 0.1}, {0.0, neck_y},
               {0.13 * h, y - 0.05}, {0.24 * h, y - 0.4},  {0.38 * h, y - 1.4},
               {0.55 * h, y - 2.35}, {0.75 * h, y - 2.95}, {1.0 * h, y - 3.45}};
  w.squareness = 0.45;
  w.narrow_lingual = 0.08;
  const double ends = 2.0 * h;
  // Lingual: a hollow between two marginal ridges, above the cingulum. Labial: faint furrows
  // between the three lobes.
  const double hollow = one.between(0.5, 0.75), ridge = -one.between(0.12, 0.22);
  w.dents = {{-1.0, 0.0, 1.9, hollow, {0.22 * h, 0.5 * h, 0.75 * h, 1.0 * h}},
             {-1.0, x - 1.0, 0.9, ridge, {0.2 * h, 0.45 * h, 0.7 * h, 0.95 * h}},
             {-1.0, 1.0 - x, 0.9, ridge, {0.2 * h, 0.45 * h, 0.7 * h, 0.95 * h}},
             {-1.0, -0.2, 1.6, -one.between(0.05, 0.18), {0.0, 0.12 * h, 0.2 * h, 0.42 * h}},
             {1.0, 1.35, 0.8, one.between(0.03, 0.08), {0.3 * h, 0.8 * h, ends, ends + 1}},
             {1.0, -1.35, 0.8, one.between(0.03, 0.08), {0.3 * h, 0.8 * h, ends, ends + 1}}};
  return w;
}

}  // namespace

ToothPlan incisor_plan(std::uint64_t seed) {
  Individual one(seed, 3);
  IncisorMeasures m{};
  m.length = one.draw(k_crown_length, 0.7);
  m.width = one.draw(k_crown_width, 0.7);
  m.height = one.draw(k_crown_height, 0.5);
  m.neck_length = one.draw(k_neck_length, 0.7);
  m.neck_width = one.draw(k_neck_width, 0.7);
  const double h = m.height, x = m.length / 8.6,
               edge_y = 0.5 * m.width - 2.9 + one.between(-0.1, 0.1);

  ToothPlan p;
  p.base_z_mm = -0.5 * h;
  // Three mamelons, almost worn away; the distal corner is the lower one.
  const double drop[] = {one.between(0.0, 0.1), 0.0, one.between(0.15, 0.3)};
  for (int i = 0; i < 3; ++i) {
    p.cusps.push_back({{2.7 * x * (1 - i), edge_y, h - drop[i]},
                       0.0,
                       -1.0,
                       one.between(0.06, 0.1),
                       0.9,
                       0.1,
                       0.7,
                       0.0});
    p.cusps.back().side_groove_mm = 0.0;
  }
  p.groove_low_z_mm = 0.6 * h;
  p.groove_high_z_mm = 0.9 * h;
  p.fissures.depth_mm = 0.0;
  p.fissures.pit_mm = 0.0;
  p.wall = incisor_wall(one, m);
  p.edge_round_mm = 0.5;
  p.neck = {one.draw(k_mesial_curve, 0.3), 0.0, 0.0, 0.5 * m.neck_length, 0.5 * m.neck_width};
  p.neck.distal_mm = std::min(one.draw(k_distal_curve, 0.3), p.neck.mesial_mm - 0.2);
  const double wall_enamel = one.draw(k_wall_enamel, 0.2),
               edge_enamel = one.draw(k_edge_enamel, 0.2);
  p.enamel = {wall_enamel, wall_enamel - 0.15, wall_enamel - 0.05, 5.5, edge_enamel, edge_enamel};
  p.roots = {{0.0, 0.5, -one.draw(k_root, 0.6), 0.0, -one.between(0.0, 0.7), one.between(-0.4, 0.2),
              0.515 * m.neck_length, 0.515 * m.neck_width, 1.3, 0.0}};
  PulpPlan& q = p.pulp;
  q.roof_z_mm = one.draw(k_chamber_top) * h;
  q.floor_z_mm = -1.0;
  q.middle_x_mm = 0.0;
  q.middle_y_mm = 0.0;
  q.half_x_mm = one.between(1.15, 1.4);
  q.half_y_mm = one.between(0.5, 0.6);
  // It follows the middle of the dentin, which leans labially above the cingulum, and grows thin
  // there.
  q.widen_x = 0.16;
  q.widen_y = -0.075;
  q.lean_y = 0.18;
  q.sag = 0.05;
  for (const double side : {1.0, -1.0}) {
    const double up = one.between(0.5, 0.9);
    q.horns.push_back({{side * (q.half_x_mm - 0.35), 0.18 * (q.roof_z_mm - 0.7), q.roof_z_mm - 0.7},
                       {side * (q.half_x_mm + 0.2), 0.2 * (q.roof_z_mm + up), q.roof_z_mm + up},
                       0.3,
                       0.12});
  }
  q.canals = {{0, 0.0, 0.0, one.between(0.65, 0.8), 0.2, 1.0, 0.0}};
  p.steepest = 8.0;
  return p;
}

Tooth grow_incisor(const SeedTooth& what) {
  const GrownTooth shape(incisor_plan(what.seed));
  return grow_tooth(shape, what.leaf_mm, what.periodontium_mm,
                    fmt::format("upper central incisor (seed {}, one canal)", what.seed),
                    {ToothDesign::incisor, what.seed});
}

}  // namespace cavum
