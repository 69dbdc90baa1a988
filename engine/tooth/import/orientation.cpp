#include "engine/tooth/import/orientation.h"

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"

namespace cavum {
namespace {

constexpr std::size_t k_round = 36;  // so many of 72 directions make a closed line
constexpr double k_bulge_mm =
    1.0;  // least difference of heights of contour that tells the buccal side
constexpr double k_higher_cusp_mm = 0.5;  // a premolar's buccal cusp over its lingual one
constexpr double k_cusp_off_axis_mm = 0.4;
constexpr double k_canals_apart_mm = 1.0;
constexpr double k_rise_mm = 0.15, k_taper_mm = 0.3,
                 k_root_mm =
                     0.5;  // least differences between mesial and distal that count as a sign

/// As a line: -90 to 90 degrees.
double line_deg_of(double x, double y) {
  double deg = direction_deg(x, y);
  if (deg > 90) deg -= 180;
  if (deg <= -90) deg += 180;
  return deg;
}

/// The first wave of a closed line's height around the long axis: how it falls from one side to the
/// other.
struct Fall {
  double x = 0, y = 0;  ///< mm from the axis to the side, towards +x and +y
  [[nodiscard]] double across_mm() const noexcept { return 2 * std::sqrt(x * x + y * y); }
};
std::optional<Fall> fall_of(const Polyline& line, const LongAxis& axis) {
  if (line.size() < k_round) return std::nullopt;
  Fall fall;
  double mean = 0;
  for (const Vec3 p : line) mean += dot(p - axis.through_mm, axis.occlusal);
  mean /= static_cast<double>(line.size());
  for (const Vec3 p : line) {
    const Vec3 out = p - axis.through_mm;
    const double r = std::max(std::sqrt(out.x * out.x + out.y * out.y), 1e-9),
                 down = mean - dot(out, axis.occlusal);
    fall.x += 2 * down * out.x / (r * static_cast<double>(line.size()));
    fall.y += 2 * down * out.y / (r * static_cast<double>(line.size()));
  }
  return fall;
}

/// Width along y of a closed line at `x`.
double width_at(const Polyline& line, double x) {
  double low = 1e9, high = -1e9;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec3 a = line[i], b = line[(i + 1) % line.size()];
    if ((a.x - x) * (b.x - x) >= 0) continue;
    const double y = a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  return std::max(0.0, high - low);
}

/// Heights of contour: in the cervical third on the buccal side of all back teeth, in the middle
/// third on the lingual one (Nelson, Wheeler's).
std::optional<SeenTurn> by_bulge(const Landmarks& l) {
  const auto fall = fall_of(l.height_of_contour_mm, l.long_axis);
  if (!fall || fall->across_mm() < k_bulge_mm) return std::nullopt;
  return SeenTurn{direction_deg(fall->y, -fall->x), false,
                  msg("the crown bulges {} lower there than across", as_mm(fall->across_mm(), 1))};
}

/// The buccal cusp of a premolar is the higher one; alone, it stands buccal of the axis.
std::optional<SeenTurn> by_premolar_cusps(const Landmarks& l) {
  if (l.cusps.size() == 2) {
    Vec3 across = l.cusps[0].tip_mm - l.cusps[1].tip_mm;
    const double higher = across.z;
    if (higher < 0) across = -across;
    if (std::fabs(higher) >= k_higher_cusp_mm)
      return SeenTurn{
          direction_deg(across.y, -across.x), false,
          msg("the cusp there is {} higher, as premolars have it", as_mm(std::fabs(higher), 1))};
    return SeenTurn{line_deg_of(across.y, -across.x), true, msg("the two cusps stand across it")};
  }
  if (l.cusps.size() != 1) return std::nullopt;
  const Vec3 off = l.cusps[0].tip_mm - l.long_axis.through_mm;
  if (off.x * off.x + off.y * off.y < k_cusp_off_axis_mm * k_cusp_off_axis_mm) return std::nullopt;
  return SeenTurn{direction_deg(off.y, -off.x), false,
                  msg("the only cusp that stands out lies there")};
}

/// The canals of a lower molar leave a chamber that is long from mesial to distal.
std::optional<SeenTurn> by_canals(const Landmarks& l) {
  if (l.canal_mouths.size() < 2) return std::nullopt;
  Vec3 mean;
  for (const auto& m : l.canal_mouths) mean += m.at_mm / static_cast<double>(l.canal_mouths.size());
  double xx = 0, xy = 0, yy = 0;
  for (const auto& m : l.canal_mouths) {
    const Vec3 d = m.at_mm - mean;
    xx += d.x * d.x;
    xy += d.x * d.y;
    yy += d.y * d.y;
  }
  const double apart = std::sqrt((xx - yy) * (xx - yy) + 4 * xy * xy),
               n = static_cast<double>(l.canal_mouths.size());
  if (apart / n < k_canals_apart_mm * k_canals_apart_mm) return std::nullopt;
  return SeenTurn{0.5 * direction_deg(xx - yy, 2 * xy), true,
                  msg("the canals leave the chamber along it")};
}

void count_sign(double mesial_minus_distal, double least, const Message& towards_plus,
                const Message& towards_minus, Orientation& o) {
  if (std::fabs(mesial_minus_distal) < least) return;
  ++(mesial_minus_distal > 0 ? o.mesial_for : o.mesial_against);
  o.mesial_signs.push_back(mesial_minus_distal > 0 ? towards_plus : towards_minus);
}

/// Of back teeth: the mesial side has the higher height of contour and cervical line and is the
/// broader one, and roots bend to distal (Nelson, Wheeler's); of three canals of a lower molar two
/// are mesial. A lower first premolar is higher at its distal contact (Woelfel and Scheid, Dental
/// Anatomy; recalled): there heights of contour tell nothing, nor of a premolar without a number,
/// which may be one.
void count_mesial_signs(const Landmarks& l, bool contours_tell, bool lower_molar, Orientation& o) {
  if (const auto fall = fall_of(l.height_of_contour_mm, l.long_axis)) {
    if (contours_tell)
      count_sign(-2 * fall->x, k_rise_mm, msg("higher contour towards +x"),
                 msg("higher contour towards -x"), o);
    const auto [low, high] =
        std::minmax_element(l.height_of_contour_mm.begin(), l.height_of_contour_mm.end(),
                            [](Vec3 a, Vec3 b) { return a.x < b.x; });
    const double middle = 0.5 * (low->x + high->x), off = 0.3 * (high->x - low->x);
    count_sign(width_at(l.height_of_contour_mm, middle + off) -
                   width_at(l.height_of_contour_mm, middle - off),
               k_taper_mm, msg("broader towards +x"), msg("broader towards -x"), o);
  }
  if (const auto fall = fall_of(l.neck_mm, l.long_axis)) {
    count_sign(-2 * fall->x, k_rise_mm, msg("higher neck towards +x"),
               msg("higher neck towards -x"), o);
    double apex = 0;
    for (const Vec3 p : l.apices_mm)
      apex += (p.x - l.long_axis.through_mm.x) / static_cast<double>(l.apices_mm.size());
    count_sign(-apex, k_root_mm, msg("roots bent away from +x"), msg("roots bent away from -x"), o);
  }
  if (lower_molar && l.canal_mouths.size() == 3) {
    std::vector<double> x;
    for (const auto& m : l.canal_mouths) x.push_back(m.at_mm.x);
    std::sort(x.begin(), x.end());
    constexpr double k_pair = 1.5;
    if (x[1] - x[0] > k_pair * (x[2] - x[1]))
      count_sign(1, 0.5, msg("two canals towards +x"), msg("two canals towards -x"), o);
    if (x[2] - x[1] > k_pair * (x[1] - x[0]))
      count_sign(-1, 0.5, msg("two canals towards +x"), msg("two canals towards -x"), o);
  }
}

}  // namespace

Orientation seen_orientation(const Landmarks& l, const std::optional<ToothNumber>& number) {
  Orientation o;
  const ToothClass kind = number ? number->tooth_class() : l.tooth_class.kind;
  if (kind == ToothClass::incisor || kind == ToothClass::canine) {
    if (l.incisal_edge_mm.size() > 4) {
      const Vec3 way = l.incisal_edge_mm.front() - l.incisal_edge_mm.back();
      o.turn = SeenTurn{line_deg_of(way.x, way.y), true, msg("the incisal edge runs along it")};
    }
    return o;
  }
  if (kind != ToothClass::premolar && kind != ToothClass::molar) return o;
  const bool lower_molar = kind == ToothClass::molar && number && !number->upper();
  o.turn = by_bulge(l);
  if (!o.turn && kind == ToothClass::premolar) o.turn = by_premolar_cusps(l);
  if (!o.turn && lower_molar) o.turn = by_canals(l);
  o.buccal_told = o.turn && !o.turn->line;
  const bool maybe_lower_first_premolar =
      kind == ToothClass::premolar && (!number || (!number->upper() && number->place() == 4));
  count_mesial_signs(l, !maybe_lower_first_premolar, lower_molar, o);
  return o;
}

}  // namespace cavum
