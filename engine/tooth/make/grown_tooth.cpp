#include "engine/tooth/make/grown_tooth.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cavum {
namespace {

double widest(const std::vector<Knot>& a, const std::vector<Knot>& b) {
  double most = 0.0;
  for (const auto* knots : {&a, &b})
    for (const Knot& k : *knots) most = std::max(most, k.value);
  return most + 0.3;
}

/// Depth share of a root, 0 at its top, 1 at the apex.
double depth(const RootPlan& r, double z) { return (r.top_z_mm - z) / (r.top_z_mm - r.apex_z_mm); }
double axis_x(const RootPlan& r, double s) {
  return r.top_x_mm + r.lean_mm * s + r.bend_mm * s * s;
}
double axis_y(const RootPlan& r, double s) { return r.lean_y_mm * s; }

/// About the distance to a root. The share of the cross-section that is left at height t above the
/// apex is t (taper + (1 - taper) t): linear near the apex, so that it is round.
double root_distance(const RootPlan& r, Vec3 p) {
  const double s = std::max(depth(r, p.z), 0.0), t = 1.0 - s;
  const double v = (p.y - axis_y(r, s)) / r.half_y_mm;
  const double half_x = r.half_x_mm * (1.0 - r.concave * bell(v, 0.5) * ramp(0.0, 0.3, t));
  const double u = (p.x - axis_x(r, s)) / half_x;
  const double left = t * (r.taper + (1.0 - r.taper) * t),
               left_slope =
                   (r.taper + 2 * (1.0 - r.taper) * std::max(t, 0.0)) / (r.top_z_mm - r.apex_z_mm);
  const double gx = 2 * u / half_x, gy = 2 * v / r.half_y_mm;
  return (u * u + v * v - (t > 0 ? left : t * r.taper)) /
         std::sqrt(gx * gx + gy * gy + left_slope * left_slope);
}

}  // namespace

GrownTooth::GrownTooth(ToothPlan plan)
    : plan_(std::move(plan)),
      relief_(plan_, widest(plan_.wall.mesial, plan_.wall.distal),
              widest(plan_.wall.buccal, plan_.wall.lingual)) {
  for (const CuspPlan& c : plan_.cusps) {
    highest_tip_ = std::max(highest_tip_, c.tip_mm.z);
    lowest_tip_ = std::min(lowest_tip_, c.tip_mm.z);
  }
}

double GrownTooth::neck(double x, double y) const noexcept {
  const NeckPlan& n = plan_.neck;
  const double u = x / n.half_x_mm, v = y / n.half_y_mm, q = 1.0 / (u * u + v * v + 1e-2);
  const double side = u * u * q, back = 0.5 - 0.5 * v * std::sqrt(q);
  return (u > 0 ? n.mesial_mm : n.distal_mm) * side * side + n.lingual_mm * back * (1 - side);
}

double GrownTooth::neck_mm(double x, double y) const noexcept {
  return plan_.base_z_mm + neck(x, y);
}

GrownTooth::Sides GrownTooth::enamel(Vec3 p) const noexcept {
  const EnamelPlan& e = plan_.enamel;
  const double up = std::clamp((p.z - neck(p.x, p.y)) / e.full_height_mm, 0.0, 1.0), left = 1 - up;
  const double share =
      1 - left * left *
              left;  // a steep start: enamel ends in an edge of some 40 degrees, not in a film
  return {e.proximal_mm * share, e.proximal_mm * share, e.buccal_mm * share, e.lingual_mm * share};
}

double GrownTooth::wall(Vec3 p, const Sides& less) const noexcept {
  const WallPlan& w = plan_.wall;
  const Sides s{profile(w.mesial, p.z) - less.mesial, profile(w.distal, p.z) - less.distal,
                profile(w.buccal, p.z) - less.buccal, profile(w.lingual, p.z) - less.lingual};
  // Where enamel would leave no dentin between two walls (towards an incisal edge), a thin ridge
  // remains.
  const double half_x = 0.5 * (s.mesial + s.distal),
               half_y = smooth_max(0.5 * (s.buccal + s.lingual), 0.15, 0.4);
  const double x = p.x - 0.5 * (s.mesial - s.distal), y = p.y - 0.5 * (s.buccal - s.lingual);
  const auto held = [](double c) { return std::clamp(c, -1.3, 1.3); };
  const double wide_x = half_x * (1.0 + w.narrow_lingual * held(y / half_y)),
               wide_y = half_y * (1.0 + w.narrow_distal * held(x / half_x));
  const double u = x / wide_x, v = y / wide_y, u2 = u * u, v2 = v * v;
  const double square =
      w.root_squareness + (w.squareness - w.root_squareness) * ramp(-2.5, 1.5, p.z);
  const double round = std::sqrt(u2 + v2), boxed = std::sqrt(std::sqrt(u2 * u2 + v2 * v2));
  double d = -std::min(half_x, half_y);
  if (round > 1e-6) {
    const double b3 = boxed * boxed * boxed;
    const double gu = (1 - square) * u / round + square * u * u2 / b3,
                 gv = (1 - square) * v / round + square * v * v2 / b3;
    d = ((1 - square) * round + square * boxed - 1) /
        std::sqrt(gu * gu / (wide_x * wide_x) + gv * gv / (wide_y * wide_y));
  }
  for (const DentPlan& dent : w.dents) {
    if (p.z <= dent.z_mm[0] || p.z >= dent.z_mm[3]) continue;
    const double height =
        ramp(dent.z_mm[0], dent.z_mm[1], p.z) * (1.0 - ramp(dent.z_mm[2], dent.z_mm[3], p.z));
    d += dent.depth_mm * height * bell(p.x - dent.x_mm, dent.width_mm) *
         ramp(0.1, 0.8, dent.side * v);
  }
  return d;
}

double GrownTooth::trunk(Vec3 p, bool with_enamel) const noexcept {
  double side = wall(p, with_enamel ? Sides{} : enamel(p));
  if (p.z <= plan_.groove_low_z_mm) return side;
  const Relief r = relief_.at(p.x, p.y);
  side += r.groove_mm * ramp(plan_.groove_low_z_mm, plan_.groove_high_z_mm, p.z);
  double top = 0.0;
  if (with_enamel) {
    top = (p.z - r.height_mm + r.fissure_mm) * r.slant;
  } else {
    const EnamelPlan& e = plan_.enamel;
    top = (p.z - r.height_mm) * r.plain_slant + e.valley_mm +
          (e.cusp_mm - e.valley_mm) * ramp(lowest_tip_ - 2.0, highest_tip_, r.height_mm);
  }
  return smooth_max(side, top, plan_.edge_round_mm);
}

double GrownTooth::body(Vec3 p, bool with_enamel) const noexcept {
  const double rooted = ramp(0.2, -plan_.rooted_z_mm, -p.z);
  if (rooted <= 0.0) return trunk(p, with_enamel);
  double roots = root_distance(plan_.roots.front(), p);
  for (std::size_t i = 1; i < plan_.roots.size(); ++i)
    roots = smooth_min(roots, root_distance(plan_.roots[i], p), 0.8);
  if (rooted >= 1.0) return roots;
  // The wall of the neck turns into the roots without a step. Deep inside the trunk's distance
  // levels off, or it would hold the roots together.
  double trunk_mm = trunk(p, with_enamel);
  if (trunk_mm < 0) trunk_mm /= 1.0 - trunk_mm / 1.2;
  return roots + (1.0 - rooted) * (trunk_mm - roots);
}

double GrownTooth::outside(Vec3 p) const noexcept {
  p.z -= plan_.base_z_mm;
  return body(p, true);
}

double GrownTooth::core(Vec3 p) const noexcept {
  p.z -= plan_.base_z_mm;
  return body(p, false);
}

double GrownTooth::canal(Vec3 p, const CanalPlan& c) const noexcept {
  constexpr int k_parts = 8;
  const RootPlan& root = plan_.roots[c.root];
  const double from_z = plan_.pulp.floor_z_mm + 0.15, to_z = root.apex_z_mm + 1.0;
  // An oval canal is a round one seen in a frame that is pressed together from buccal to lingual;
  // it becomes rounder towards its end.
  const double down = std::clamp((from_z - p.z) / (from_z - to_z), 0.0, 1.0),
               oval = 1.0 + (c.oval - 1.0) * (1 - 0.6 * down);
  const Vec3 pressed{
      p.x, (p.y - axis_y(root, depth(root, p.z)) - c.y_mm * (1 - c.draw_in * down)) / oval, p.z};
  double d = 1e9;
  Vec3 before;
  double before_r = 0.0;
  for (int i = 0; i <= k_parts; ++i) {
    const double t = static_cast<double>(i) / k_parts, z = from_z + t * (to_z - from_z);
    const Vec3 here{axis_x(root, depth(root, z)) + c.x_mm * (1 - t) * (1 - t), 0.0, z};
    const double r = c.mouth_mm + (c.end_mm - c.mouth_mm) * t * (1.6 - 0.6 * t);
    if (i > 0) d = std::min(d, round_cone(pressed, before, before_r, here, r));
    before = here;
    before_r = r;
  }
  return d;
}

double GrownTooth::pulp(Vec3 p) const noexcept {
  p.z -= plan_.base_z_mm;
  const PulpPlan& q = plan_.pulp;
  const double x = p.x - q.middle_x_mm, y = p.y - q.middle_y_mm - q.lean_y * std::max(p.z, 0.0);
  const double up = p.z - 0.5 * (q.roof_z_mm + q.floor_z_mm);
  const double side = tube(x, y, std::max(q.half_x_mm + q.widen_x * up, 0.2),
                           std::max(q.half_y_mm + q.widen_y * up, 0.2));
  const double roof = q.roof_z_mm + q.sag * std::sqrt(x * x + y * y + 0.04);
  double d = smooth_max(side, std::max(p.z - roof, q.floor_z_mm - p.z), std::min(0.8, q.half_x_mm));
  for (const HornPlan& h : q.horns)
    d = smooth_min(d, round_cone(p, h.from_mm, h.from_radius_mm, h.to_mm, h.to_radius_mm), 0.4);
  double canals = 1e9;
  for (const CanalPlan& c : q.canals) canals = std::min(canals, canal(p, c));
  return smooth_min(d, canals, 0.5);  // the mouths are funnels
}

FormulaBox GrownTooth::box() const {
  const WallPlan& w = plan_.wall;
  double bottom = 0.0, low_x = 0.0, high_x = 0.0;
  for (const RootPlan& r : plan_.roots) {
    bottom = std::min(bottom, r.apex_z_mm);
    for (int i = 0; i <= 10; ++i) {
      const double s = 0.1 * i, half = r.half_x_mm * std::sqrt(1.0 - s);
      low_x = std::min(low_x, axis_x(r, s) - half);
      high_x = std::max(high_x, axis_x(r, s) + half);
    }
  }
  const auto most = [](const std::vector<Knot>& knots) {
    double m = 0.0;
    for (const Knot& k : knots) m = std::max(m, k.value);
    return m;
  };
  return {{std::min(-most(w.distal), low_x) - 0.3, -most(w.lingual) - 0.5,
           plan_.base_z_mm + bottom - 0.2},
          {std::max(most(w.mesial), high_x) + 0.3, most(w.buccal) + 0.5,
           plan_.base_z_mm + highest_tip_ + 0.2}};
}

Tooth grow_tooth(const GrownTooth& shape, double leaf_mm, double periodontium_mm,
                 const std::string& name, const FormulaKind& what) {
  return build_formula_tooth(shape, shape.box(), leaf_mm, periodontium_mm, name, what);
}

}  // namespace cavum
