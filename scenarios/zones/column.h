// An outline dropped along an axis, down to a floor: what columns are made of, upright or leaning.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "scenarios/zones/outline.h"
#include "scenarios/zones/relief.h"
#include "scenarios/zones/shape.h"

namespace cavum::scenarios {

/// Distance of a body that is the meeting of two independent directions.
[[nodiscard]] inline double meet(double a, double b) noexcept {
  if (a > 0 && b > 0) return std::sqrt(a * a + b * b);
  return std::max(a, b);
}

/// It has no upper end, for the opening is no wall. Heights and the outline's plane are those of
/// the frame in which it stands upright.
class Column final : public Shape {
 public:
  /// `bottom`: the floor's height for each column of leaves. The outline's distance is the same all
  /// the way down, so it is taken once for each of them. The walls open by `taper_deg` upwards; at
  /// height `outline_z` they are as drawn.
  Column(std::unique_ptr<Outline> outline, ColumnMap bottom, double taper_deg, double outline_z);
  double distance_mm(Vec3 p) const noexcept override {
    const double side = (outline_mm(p.x, p.y) - tan_ * (p.z - outline_z_)) * cos_;
    return meet(side, bottom_.at(p.x, p.y) - p.z);
  }

 private:
  [[nodiscard]] double centre(double origin, int i) const noexcept {
    return origin + (i + 0.5) * bottom_.leaf_mm;
  }
  [[nodiscard]] double outline_mm(double x_mm, double y_mm) const noexcept;
  std::unique_ptr<Outline> outline_;
  ColumnMap bottom_;
  std::vector<double> at_centre_;  // by ColumnMap::index of the bottom's columns
  double outline_z_, tan_ = 0.0, cos_ = 1.0;
};

}  // namespace cavum::scenarios
