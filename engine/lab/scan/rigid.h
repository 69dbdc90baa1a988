// A motion without change of size, and the small one that lays points onto planes: the step of an
// ICP.
#pragma once

#include <array>
#include <optional>

#include "engine/base/pose.h"

namespace cavum {

/// p -> rotation · p + shift.
struct Rigid {
  Mat3 rotation;
  Vec3 shift_mm;
  [[nodiscard]] Vec3 operator*(Vec3 p) const noexcept { return rotation * p + shift_mm; }
  /// First `first`, then this.
  [[nodiscard]] Rigid after(const Rigid& first) const noexcept {
    const auto column = [&](Vec3 axis) { return rotation * (first.rotation * axis); };
    const Vec3 x = column({1, 0, 0}), y = column({0, 1, 0}), z = column({0, 0, 1});
    return {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}},
            rotation * first.shift_mm + shift_mm};
  }
};

/// Angle between two rotations, as its cosine: (trace(A Bᵀ) - 1) / 2.
[[nodiscard]] inline double cosine_between(const Mat3& a, const Mat3& b) noexcept {
  return 0.5 * (dot(a.row_x, b.row_x) + dot(a.row_y, b.row_y) + dot(a.row_z, b.row_z) - 1.0);
}

/// Least squares of point to plane: the small motion x = (w, t) that makes Σ weight ((p - c) × n ·
/// w + n · t + r)² least, for points p with signed distance r to a plane of unit normal n. Source:
/// Chen and Medioni, Image and Vision Computing 10 (1992) 145; rotation about the middle c.
class PlaneSteps {
 public:
  explicit PlaneSteps(Vec3 middle_mm) noexcept : middle_mm_(middle_mm) {}
  void add(Vec3 p, Vec3 normal, double distance_mm, double weight) noexcept {
    const Vec3 turn = cross(p - middle_mm_, normal);
    const std::array<double, 6> a{turn.x, turn.y, turn.z, normal.x, normal.y, normal.z};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j <= i; ++j) normal_[k++] += weight * a[i] * a[j];
      right_[i] -= weight * a[i] * distance_mm;
    }
    weight_ += weight;
  }
  /// None where the points leave a motion open altogether: fewer than six, or no weight.
  [[nodiscard]] std::optional<Rigid> solve() const;

 private:
  Vec3 middle_mm_;
  std::array<double, 21> normal_{};  // lower triangle, row by row
  std::array<double, 6> right_{};
  double weight_ = 0.0;
};

}  // namespace cavum
