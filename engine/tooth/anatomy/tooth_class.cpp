#include "engine/tooth/anatomy/tooth_class.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"

namespace cavum {
namespace {

constexpr double k_top_mm = 1.0, k_level_mm = 0.05;
// Mean crown widths (mesiodistal x buccolingual, mm; Nelson, Wheeler's Dental Anatomy, table of
// measurements): incisors 5-8.5 x 6-7, canines 7-7.5 x 7.5-8, premolars 7 x 7.5-9, molars 8.5-11
// x 9.5-11. Premolars have at most 7 x 9 = 63 mm2, molars at least 8.5 x 9.5 = 81.
constexpr double k_premolar_mm2 = 70.0, k_molar_mm2 = 76.0, k_large_mm2 = 88.0;

/// Length and width of a set of places by their longest direction, every 5 degrees.
struct Span {
  double largest = 0, across = 0;
};
Span span_of(const std::vector<Vec3>& places) {
  Span span;
  constexpr int k_steps = 36;
  const auto width = [&](int i) {
    const SinCos d = det_sincos(k_pi * i / k_steps);
    double low = 1e9, high = -1e9;
    for (const Vec3 p : places) {
      const double u = p.x * d.cos + p.y * d.sin;
      low = std::min(low, u);
      high = std::max(high, u);
    }
    return high > low ? high - low : 0.0;
  };
  for (int i = 0; i < k_steps; ++i)
    if (const double w = width(i); w > span.largest) {
      span.largest = w;
      span.across = width(i + k_steps / 2);
    }
  return span;
}

}  // namespace

ClassSigns class_signs(const CrownWalls& walls, const std::vector<int>& contour,
                       const HeightMap& map, std::size_t cusps, bool table) {
  ClassSigns s;
  s.cusps = cusps;
  s.table = table;
  std::vector<Vec3> wide, top;
  double low_x = 1e9, high_x = -1e9, low_y = 1e9, high_y = -1e9;
  for (int d = 0; d < CrownWalls::k_directions; ++d) {
    if (contour[static_cast<std::size_t>(d)] < 0) continue;
    const Vec3 p = walls.place(contour[static_cast<std::size_t>(d)], d);
    wide.push_back(p);
    low_x = std::min(low_x, p.x);
    high_x = std::max(high_x, p.x);
    low_y = std::min(low_y, p.y);
    high_y = std::max(high_y, p.y);
  }
  if (wide.empty()) return s;
  s.wide_x_mm = high_x - low_x;
  s.wide_y_mm = high_y - low_y;
  const Span crown = span_of(wide);
  s.long_mm = crown.largest;
  s.short_mm = crown.across;
  double highest = -1e9;
  int all = 0, level = 0;
  for (int c = 0; c < map.count(); ++c)
    if (map.on[static_cast<std::size_t>(c)] != 0) highest = std::max(highest, map.at(c));
  for (int c = 0; c < map.count(); ++c) {
    if (map.on[static_cast<std::size_t>(c)] == 0) continue;
    ++all;
    level += map.at(c) > highest - k_level_mm ? 1 : 0;
    if (map.at(c) > highest - k_top_mm) top.push_back(map.place(c));
  }
  const Span high = span_of(top);
  s.top_long_mm = high.largest;
  s.top_short_mm = high.across;
  s.level_share = all > 0 ? static_cast<double>(level) / all : 0.0;
  return s;
}

ClassGuess guess_class(const ClassSigns& s) {
  ClassGuess guess;
  const double area = s.wide_x_mm * s.wide_y_mm;
  const auto say = [&](ToothClass kind, double probability, const Message& shape) {
    guess = {kind, probability,
             msg("{}; crown {} x {}", shape, as_number(s.wide_x_mm, 1), as_mm(s.wide_y_mm, 1))};
  };
  if (s.level_share > 0.3) {
    say(ToothClass::unknown, 0.0, msg("{} of the top are level", as_percent(100 * s.level_share)));
    return guess;
  }
  const Number top_long = as_number(s.top_long_mm, 1), top_short = as_mm(s.top_short_mm, 1);
  const bool small = s.long_mm < 10.0;
  if (!s.table && s.cusps <= 1 && small) {
    const double slender = s.top_long_mm / std::max(s.top_short_mm, 0.1),
                 share = s.top_long_mm / s.long_mm;
    if (slender >= 1.8 && share >= 0.6)
      say(ToothClass::incisor, share >= 0.7 ? 0.9 : 0.7,
          msg("an edge and no table: the highest millimetre is {} x {}", top_long, top_short));
    else if (share <= 0.5 && slender < 2.2)
      say(ToothClass::canine, share <= 0.45 ? 0.8 : 0.6,
          msg("one cusp and no table: the highest millimetre is {} x {}", top_long, top_short));
    else
      say(ToothClass::unknown, 0.0,
          msg("between an edge and a cusp: the highest millimetre is {} x {}", top_long,
              top_short));
    return guess;
  }
  if (!s.table && s.cusps <= 1) {
    say(ToothClass::unknown, 0.0, msg("one cusp, no table, and wider than front teeth"));
    return guess;
  }
  const Message seen =
      s.table ? msgn("{} cusp around a table", "{} cusps around a table", s.cusps, s.cusps)
              : msgn("{} cusp", "{} cusps", s.cusps, s.cusps);
  const bool many = s.cusps >= 4, some = s.cusps == 3;
  if (area >= k_molar_mm2) {
    // a table of that size is a molar's, however worn its cusps are
    const bool large = s.table && area >= k_large_mm2;
    say(many || some || large ? ToothClass::molar : ToothClass::unknown,
        many    ? 0.95
        : some  ? 0.8
        : large ? 0.7
                : 0.0,
        seen);
  } else if (area <= k_premolar_mm2)
    say(s.cusps <= 3 ? ToothClass::premolar : ToothClass::unknown,
        s.cusps == 2   ? 0.95
        : s.cusps <= 3 ? 0.7
                       : 0.0,
        seen);
  else
    say(many           ? ToothClass::molar
        : s.cusps == 2 ? ToothClass::premolar
                       : ToothClass::unknown,
        many || s.cusps == 2 ? 0.6 : 0.0, msg("{}, of a size between premolar and molar", seen));
  return guess;
}

}  // namespace cavum
