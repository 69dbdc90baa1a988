// Rotation and pose of the handpiece. Quaternions are turned into matrices by arithmetic alone.
#pragma once

#include "engine/base/vec.h"

namespace cavum {

/// Unit quaternion, scalar first.
struct Quat {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
  friend constexpr bool operator==(const Quat&, const Quat&) = default;
};

/// Row-major 3x3 rotation.
struct Mat3 {
  Vec3 row_x{1, 0, 0}, row_y{0, 1, 0}, row_z{0, 0, 1};

  [[nodiscard]] constexpr Vec3 operator*(Vec3 v) const noexcept {
    return {dot(row_x, v), dot(row_y, v), dot(row_z, v)};
  }
  /// The inverse rotation applied to `v`.
  [[nodiscard]] constexpr Vec3 transposed(Vec3 v) const noexcept {
    return row_x * v.x + row_y * v.y + row_z * v.z;
  }
  friend constexpr bool operator==(const Mat3&, const Mat3&) = default;
};

[[nodiscard]] inline Quat normalized(Quat q) noexcept {
  const double n = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!(n > 1e-9)) return {};
  return {q.w / n, q.x / n, q.y / n, q.z / n};
}

[[nodiscard]] constexpr Mat3 rotation(Quat q) noexcept {
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {{1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy)},
          {2 * (xy + wz), 1 - 2 * (xx + zz), 2 * (yz - wx)},
          {2 * (xz - wy), 2 * (yz + wx), 1 - 2 * (xx + yy)}};
}

/// Shortest rotation that carries unit vector `from` onto unit vector `to`; of opposite ones, half
/// a turn about some axis across `from`. Right to 1e-12 everywhere. Near the opposite 1 + from·to
/// has lost its digits: there w = |from + to| / 2, and the axis is along from x (from + to).
[[nodiscard]] inline Quat rotation_between(Vec3 from, Vec3 to) noexcept {
  const double d = dot(from, to);
  if (d < -0.999999) {
    const Vec3 sum = from + to;
    const double w = 0.5 * length(sum);
    if (w > 1e-15) {  // else nothing is left of the sum but rounding
      const Vec3 axis = cross(from, sum);
      const double s = 0.5 * length(to - from) / length(axis);
      return normalized(Quat{w, axis.x * s, axis.y * s, axis.z * s});
    }
    const Vec3 side =
        normalized(std::fabs(from.x) < 0.6 ? cross(from, {1, 0, 0}) : cross(from, {0, 1, 0}));
    return {0.0, side.x, side.y, side.z};
  }
  const Vec3 c = cross(from, to);
  return normalized(Quat{1.0 + d, c.x, c.y, c.z});
}

/// Tip of the bur in the tooth frame, and the rotation from tool frame to tooth frame.
struct Pose {
  Vec3 tip_mm;
  Quat rotation;
};

}  // namespace cavum
