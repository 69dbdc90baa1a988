// The list of measures of each kind of tooth, taken with the meter: what docs/teeth.md holds beside
// published figures.
#include <algorithm>
#include <cmath>

#include "engine/base/order.h"
#include "tests/engine/tooth/make/tooth_meter.h"

namespace cavum::testing_tooth {
namespace {

/// What all kinds have: crown, neck, root, heights of contour. `high_z`: the tip that crown height
/// goes by.
struct Common {
  double buccal_cej, lingual_cej, mesial_cej, distal_cej;
};

Common add_common(const ToothMeter& t, double tip_z, Measures& m) {
  const Common c{t.cervical_z('y', 1), t.cervical_z('y', -1), t.cervical_z('x', 1),
                 t.cervical_z('x', -1)};
  const double up = c.buccal_cej + 0.2, top = tip_z + 1;
  const auto mesial = t.outermost('x', 1, up, top), distal = t.outermost('x', -1, up, top);
  const auto buccal = t.outermost('y', 1, up, top), lingual = t.outermost('y', -1, up, top);
  const auto neck = [&](char towards, double sign, double z) {
    return t.outermost(towards, sign, z - 0.45, z - 0.25, 0.0, 0.6).first;
  };
  m.emplace_back("crown width mesiodistal", mesial.first + distal.first);
  m.emplace_back("crown width buccolingual", buccal.first + lingual.first);
  m.emplace_back("crown height buccal", tip_z - c.buccal_cej);
  m.emplace_back("neck width mesiodistal",
                 neck('x', 1, c.mesial_cej) + neck('x', -1, c.distal_cej));
  m.emplace_back("neck width buccolingual",
                 neck('y', 1, c.buccal_cej) + neck('y', -1, c.lingual_cej));
  m.emplace_back("rise of the cervical line mesial",
                 c.mesial_cej - std::min(c.buccal_cej, c.lingual_cej));
  m.emplace_back("rise of the cervical line distal",
                 c.distal_cej - std::min(c.buccal_cej, c.lingual_cej));
  m.emplace_back("height of contour buccal, share of the crown",
                 (buccal.second - c.buccal_cej) / (tip_z - c.buccal_cej));
  m.emplace_back("height of contour lingual, share of the crown",
                 (lingual.second - c.lingual_cej) / (tip_z - c.lingual_cej));
  m.emplace_back("contact mesial, share of the crown",
                 (mesial.second - c.buccal_cej) / (tip_z - c.buccal_cej));
  m.emplace_back("contact distal, share of the crown",
                 (distal.second - c.buccal_cej) / (tip_z - c.buccal_cej));
  return c;
}

/// Fissure between low_x and high_x.
void add_fissure(const ToothMeter& t, double low_x, double high_x, double tip_z, Measures& m) {
  std::vector<double> angle, depth, enamel;
  double lowest = 1e9;
  for (double x = low_x; x <= high_x + 1e-9; x += (high_x - low_x) / 12) {
    const auto v = t.valley(x, -1.6, 1.6);
    angle.push_back(v.angle_deg);
    depth.push_back(v.depth_mm);
    enamel.push_back(t.enamel_mm({x, v.y_mm, v.z_mm}));
    lowest = std::min(lowest, v.z_mm);
  }
  m.emplace_back("fissure angle, degrees", median(angle));
  m.emplace_back("fissure depth below its shoulders", median(depth));
  m.emplace_back("enamel under the fissure", median(enamel));
  m.emplace_back("highest tip over the deepest fissure", tip_z - lowest);
}

double apart(Vec3 a, Vec3 b) { return length(a - b); }
double apart(const CanalSlice& a, const CanalSlice& b) {
  return std::sqrt((a.x_mm - b.x_mm) * (a.x_mm - b.x_mm) + (a.y_mm - b.y_mm) * (a.y_mm - b.y_mm));
}

/// z where a tissue begins, from above.
double first_z(const std::vector<std::pair<std::uint8_t, double>>& column, std::uint8_t tissue) {
  for (const auto& [t, z] : column)
    if (t == tissue) return z;
  return 1e9;
}

/// z where pulp ends, and where hard tissue ends below it.
double pulp_end_z(const std::vector<std::pair<std::uint8_t, double>>& column) {
  for (std::size_t i = 0; i + 1 < column.size(); ++i)
    if (column[i].first == k_pulp) return column[i + 1].second;
  return 1e9;
}
double hard_end_z(const std::vector<std::pair<std::uint8_t, double>>& column) {
  double z = 1e9;
  for (std::size_t i = 0; i + 1 < column.size(); ++i)
    if (column[i].first == k_dentin) z = column[i + 1].second;
  return z;
}

}  // namespace

Measures measure_molar(const Tooth& tooth) {
  const ToothMeter t(tooth);
  Measures m;
  const Vec3 mb = t.highest(1.0, 4.0, 1.3, 4.2), db = t.highest(-2.4, 0.2, 1.6, 4.2),
             ml = t.highest(0.9, 4.0, -4.6, -1.5);
  const Vec3 dl = t.highest(-4.0, -0.8, -4.6, -1.5);
  const Vec3 d = t.highest(-4.9, -3.0, 0.4, 2.6);
  const Common c = add_common(t, mb.z, m);
  m.emplace_back("root mesial", c.buccal_cej - t.apex_z(0.0, 9.0));
  m.emplace_back("root distal", c.buccal_cej - t.apex_z(-9.0, 0.0));
  m.emplace_back("tips MB to ML", apart(mb, ml));
  m.emplace_back("tips MB to DB", apart(mb, db));
  m.emplace_back("tips ML to DL", apart(ml, dl));
  m.emplace_back("tips DB to DL", apart(db, dl));
  m.emplace_back("lingual tips over buccal ones", 0.5 * (ml.z + dl.z - mb.z - db.z));
  m.emplace_back("tip D below MB", mb.z - d.z);
  add_fissure(t, -1.8, 2.2, std::max(ml.z, dl.z), m);
  m.emplace_back("enamel at tip MB", t.enamel_mm(mb));
  m.emplace_back("enamel at tip ML", t.enamel_mm(ml));
  const double half = c.buccal_cej + 0.5 * (mb.z - c.buccal_cej);
  m.emplace_back("enamel buccal, half way up", t.wall_enamel_mm('y', 1, half, 2.0));
  m.emplace_back("enamel lingual, half way up", t.wall_enamel_mm('y', -1, half, 2.0));
  m.emplace_back("enamel mesial, at the contact", t.wall_enamel_mm('x', 1, half + 0.8, 0.0));
  m.emplace_back("enamel buccal, 1 mm above the cervical line",
                 t.wall_enamel_mm('y', 1, c.buccal_cej + 1.0, 2.0));
  const auto middle = t.column(0.1, 0.0);
  const double roof = first_z(middle, k_pulp), floor = pulp_end_z(middle),
               furcation = hard_end_z(middle);
  m.emplace_back("buccal tip to chamber roof", mb.z - roof);
  m.emplace_back("buccal tip to chamber floor", mb.z - floor);
  m.emplace_back("buccal tip to furcation", mb.z - furcation);
  m.emplace_back("chamber height", roof - floor);
  m.emplace_back("chamber floor to furcation", floor - furcation);
  m.emplace_back("chamber roof to furcation", roof - furcation);
  m.emplace_back("chamber roof over the proximal cervical line",
                 roof - 0.5 * (c.mesial_cej + c.distal_cej));
  m.emplace_back("fossa to chamber roof", first_z(middle, k_enamel) - roof);
  m.emplace_back("dentin over the chamber roof", first_z(middle, k_dentin) - roof);
  m.emplace_back("tip MB to the nearest pulp", t.to_pulp_mm(mb));
  m.emplace_back("dentin over horn MB", t.horn_to_enamel_mm(1.8, 1.7));
  const auto chamber = t.canals(0.5 * (roof + floor));
  m.emplace_back("chamber length mesiodistal", chamber.front().mesiodistal_mm);
  m.emplace_back("chamber width buccolingual", chamber.front().buccolingual_mm);
  m.emplace_back("root trunk buccal", c.buccal_cej - hard_end_z(t.column(0.0, 2.8)));
  const auto mouths = t.canals(floor - 1.0);
  m.emplace_back("canals", static_cast<double>(mouths.size()));
  if (mouths.size() == 3) {
    m.emplace_back("mouths of the mesial canals, apart", apart(mouths[1], mouths[2]));
    m.emplace_back("mouths of distal and mesial canals, apart",
                   0.5 * (apart(mouths[0], mouths[1]) + apart(mouths[0], mouths[2])));
    m.emplace_back("mesial canal at its mouth, mesiodistal",
                   0.5 * (mouths[1].mesiodistal_mm + mouths[2].mesiodistal_mm));
    m.emplace_back("distal canal at its mouth, buccolingual", mouths[0].buccolingual_mm);
  }
  const auto below = t.canals(furcation - 2.0);
  if (below.size() == 3)
    m.emplace_back("mesial canals to the furcal wall, 2 mm below the furcation",
                   0.5 * (t.to_outside_mm(below[1], furcation - 2.0) +
                          t.to_outside_mm(below[2], furcation - 2.0)));
  const auto deep = t.canals(t.apex_z(0.0, 9.0) + 4.0);
  if (!deep.empty()) {
    m.emplace_back("mesial canals 4 mm above the apex, mesiodistal", deep.back().mesiodistal_mm);
    m.emplace_back("mesial canals 4 mm above the apex, buccolingual", deep.back().buccolingual_mm);
  }
  return m;
}

Measures measure_premolar(const Tooth& tooth) {
  const ToothMeter t(tooth);
  Measures m;
  const Vec3 b = t.highest(-1.2, 1.2, 1.3, 4.0), l = t.highest(-1.0, 1.4, -4.0, -1.3);
  const Common c = add_common(t, b.z, m);
  const double apex = t.apex_z(-9, 9);
  m.emplace_back("root", c.buccal_cej - apex);
  m.emplace_back("tips buccal to lingual", apart(b, l));
  m.emplace_back("buccal tip over lingual one", b.z - l.z);
  m.emplace_back("lingual tip mesial of the buccal one", l.x - b.x);
  add_fissure(t, -1.0, 1.0, b.z, m);
  m.emplace_back("enamel at the buccal tip", t.enamel_mm(b));
  m.emplace_back("enamel at the lingual tip", t.enamel_mm(l));
  const double half = c.buccal_cej + 0.5 * (b.z - c.buccal_cej);
  m.emplace_back("enamel buccal, half way up", t.wall_enamel_mm('y', 1, half, 0.0));
  m.emplace_back("enamel lingual, half way up", t.wall_enamel_mm('y', -1, half, 0.0));
  m.emplace_back("enamel mesial, at the contact", t.wall_enamel_mm('x', 1, half + 0.8, 0.0));
  m.emplace_back("enamel distal, at the contact", t.wall_enamel_mm('x', -1, half + 0.6, 0.0));
  m.emplace_back("enamel buccal, 1 mm above the cervical line",
                 t.wall_enamel_mm('y', 1, c.buccal_cej + 1.0, 0.0));
  const auto middle = t.column(0.0, 0.0);
  const double roof = first_z(middle, k_pulp);
  m.emplace_back("tips to chamber roof", 0.5 * (b.z + l.z) - roof);
  m.emplace_back("chamber roof over the cervical line", roof - c.buccal_cej);
  m.emplace_back("fissure to chamber roof", first_z(middle, k_enamel) - roof);
  m.emplace_back("dentin over the chamber roof", first_z(middle, k_dentin) - roof);
  m.emplace_back("buccal tip to the nearest pulp", t.to_pulp_mm(b));
  m.emplace_back("dentin over the buccal horn", t.horn_to_enamel_mm(0.0, 2.0));
  const auto chamber = t.canals(c.buccal_cej + 0.2);
  m.emplace_back("pulp at the neck, mesiodistal", chamber.front().mesiodistal_mm);
  m.emplace_back("pulp at the neck, buccolingual", chamber.front().buccolingual_mm);
  const auto halfway = t.canals(0.5 * (c.buccal_cej + apex));
  m.emplace_back("canals", static_cast<double>(halfway.size()));
  m.emplace_back("canal at half the root, mesiodistal", halfway.front().mesiodistal_mm);
  m.emplace_back("canal at half the root, buccolingual", halfway.front().buccolingual_mm);
  const double neck_z = 0.5 * (c.buccal_cej + apex);
  m.emplace_back("root width at half its length, buccolingual",
                 t.outermost('y', 1, neck_z - 0.1, neck_z + 0.1).first +
                     t.outermost('y', -1, neck_z - 0.1, neck_z + 0.1).first);
  return m;
}

Measures measure_incisor(const Tooth& tooth) {
  const ToothMeter t(tooth);
  Measures m;
  const Vec3 edge = t.highest(-3.5, 3.5, -1.5, 2.5);
  const Common c = add_common(t, edge.z, m);
  const double apex = t.apex_z(-9, 9);
  m.emplace_back("root", c.buccal_cej - apex);
  m.emplace_back("root over crown", (c.buccal_cej - apex) / (edge.z - c.buccal_cej));
  const auto thick = [&](double z) {
    return t.outermost('y', 1, z - 0.1, z + 0.1, 0.0, 0.3).first +
           t.outermost('y', -1, z - 0.1, z + 0.1, 0.0, 0.3).first;
  };
  m.emplace_back("thickness 2 mm below the edge", thick(edge.z - 2.0));
  m.emplace_back("thickness at half the crown", thick(0.5 * (edge.z + c.buccal_cej)));
  const double fossa = edge.z - 0.35 * (edge.z - c.buccal_cej);
  const auto lingual_y = [&](double from_x, double to_x) {
    return t
        .outermost('y', -1, fossa - 0.1, fossa + 0.1, 0.5 * (from_x + to_x), 0.5 * (to_x - from_x))
        .first;
  };
  m.emplace_back("depth of the lingual fossa below its ridges",
                 std::min(lingual_y(1.5, 4.0), lingual_y(-4.0, -1.5)) - lingual_y(-0.3, 0.3));
  m.emplace_back("enamel at the edge", t.enamel_mm(t.highest(-0.2, 0.2, -1.5, 2.5)));
  m.emplace_back("enamel labial, 1 mm above the cervical line",
                 t.wall_enamel_mm('y', 1, c.buccal_cej + 1.0, 0.0));
  m.emplace_back("enamel labial, 3 mm above the cervical line",
                 t.wall_enamel_mm('y', 1, c.buccal_cej + 3.0, 0.0));
  m.emplace_back("enamel labial, 5 mm above the cervical line",
                 t.wall_enamel_mm('y', 1, c.buccal_cej + 5.0, 0.0));
  m.emplace_back("enamel lingual, 5 mm above the cervical line",
                 t.wall_enamel_mm('y', -1, c.lingual_cej + 5.0, 0.0));
  m.emplace_back("enamel mesial, 2.5 mm below the edge",
                 t.wall_enamel_mm('x', 1, edge.z - 2.5, edge.y));
  double pulp_top = 0.0;
  for (double z = edge.z; z > apex && pulp_top == 0.0; z -= 0.05)
    if (!t.canals(z).empty()) pulp_top = z;
  m.emplace_back("edge to the pulp's horns", edge.z - pulp_top);
  m.emplace_back("edge to the nearest pulp", t.to_pulp_mm(t.highest(-0.2, 0.2, -1.5, 2.5)));
  const auto chamber = t.canals(pulp_top - 1.6), neck = t.canals(c.buccal_cej);
  m.emplace_back("chamber mesiodistal near its top", chamber.front().mesiodistal_mm);
  m.emplace_back("chamber labiolingual near its top", chamber.front().buccolingual_mm);
  m.emplace_back("pulp at the neck, mesiodistal", neck.front().mesiodistal_mm);
  m.emplace_back("pulp at the neck, labiolingual", neck.front().buccolingual_mm);
  const auto halfway = t.canals(0.5 * (c.buccal_cej + apex));
  m.emplace_back("canals", static_cast<double>(halfway.size()));
  m.emplace_back("canal at half the root, mesiodistal", halfway.front().mesiodistal_mm);
  const double neck_z = c.buccal_cej + 3.0;
  m.emplace_back(
      "lingual surface to the pulp, at the cingulum",
      t.to_pulp_mm(
          {0.0, -t.outermost('y', -1, neck_z - 0.1, neck_z + 0.1, 0.0, 0.3).first, neck_z}));
  return m;
}

}  // namespace cavum::testing_tooth
