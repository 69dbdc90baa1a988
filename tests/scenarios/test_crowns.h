// Crowns of known geometry with the landmarks that belong to them, written down by hand.
#pragma once

#include <cmath>

#include "engine/tooth/anatomy/landmarks.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::testing {

/// An upright round tooth of dentin: radius `radius_mm`, its flat top at z = 0, its lower end at z
/// = `low_mm`; air around it.
inline Tooth round_tooth(double radius_mm, double low_mm, double leaf_mm) {
  const double half = radius_mm + 0.5;
  const auto outside = [radius_mm](Vec3 p) {
    return std::max(std::sqrt(p.x * p.x + p.y * p.y) - radius_mm, p.z);
  };
  return make_tooth(
      {-half, -half, low_mm}, {half, half, 1.0}, leaf_mm,
      [outside](Vec3 p) -> std::uint8_t { return outside(p) < 0 ? k_dentin : k_air; }, outside);
}

/// Its neck: a circle of that radius, `rise_mm` higher at the mesial and distal ends than in the
/// middle of the other sides (by the square of x).
inline Landmarks round_landmarks(double radius_mm, double neck_z_mm, double rise_mm = 0) {
  Landmarks l;
  for (int i = 0; i < 360; ++i) {
    const double a = i * 3.14159265358979323846 / 180, x = std::cos(a), y = std::sin(a);
    l.neck_mm.push_back({radius_mm * x, radius_mm * y, neck_z_mm + rise_mm * x * x});
  }
  l.long_axis.through_mm = {0, 0, neck_z_mm};
  return l;
}

}  // namespace cavum::testing
