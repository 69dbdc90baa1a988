// Shapes that teeth of our own are made from: smooth unions, profiles, tubes, round cones. Lengths
// in mm; a body's function is negative inside and about a distance near its surface. Only + - * /
// and sqrt: the same bytes everywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/base/vec.h"

namespace cavum {

/// Smooth maximum (intersection) and minimum (union): rounds the meeting of two surfaces over about
/// k mm.
[[nodiscard]] inline double smooth_max(double a, double b, double k) {
  const double h = std::max(k - std::fabs(a - b), 0.0) / k;
  return std::max(a, b) + h * h * k * 0.25;
}
[[nodiscard]] inline double smooth_min(double a, double b, double k) {
  return -smooth_max(-a, -b, k);
}

/// 0 below `low`, 1 above `high`, smooth between.
[[nodiscard]] inline double ramp(double low, double high, double v) {
  const double t = std::clamp((v - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// A bell of height 1 and half width about `width`.
[[nodiscard]] inline double bell(double distance, double width) {
  const double t = distance / width, q = 1 / (1 + t * t);
  return q * q;
}

/// Smooth curve through (z, value) knots, z rising (Hermite, tangents from the neighbours);
/// constant beyond.
struct Knot {
  double z, value;
};
[[nodiscard]] inline double profile(std::span<const Knot> k, double z) {
  if (z <= k.front().z) return k.front().value;
  if (z >= k.back().z) return k.back().value;
  std::size_t i = 0;
  while (z > k[i + 1].z) ++i;
  const auto slope = [&](std::size_t j) {
    if (j == 0 || j + 1 == k.size()) return 0.0;
    return (k[j + 1].value - k[j - 1].value) / (k[j + 1].z - k[j - 1].z);
  };
  const double h = k[i + 1].z - k[i].z, t = (z - k[i].z) / h, t2 = t * t, t3 = t2 * t;
  return k[i].value * (2 * t3 - 3 * t2 + 1) + slope(i) * h * (t3 - 2 * t2 + t) +
         k[i + 1].value * (3 * t2 - 2 * t3) + slope(i + 1) * h * (t3 - t2);
}

/// About the distance to an upright tube whose cross-section lies between an ellipse and a rounded
/// rectangle.
[[nodiscard]] inline double tube(double x, double y, double half_x, double half_y) {
  const double u = x / half_x, v = y / half_y, u2 = u * u, v2 = v * v;
  const double q = 0.5 * std::sqrt(u2 + v2) + 0.5 * std::sqrt(std::sqrt(u2 * u2 + v2 * v2));
  if (q < 0.05) return -std::min(half_x, half_y);
  return std::sqrt(x * x + y * y) * (1 - 1 / q);
}

/// Exact distance to a round cone: the hull of two balls.
[[nodiscard]] inline double round_cone(Vec3 p, Vec3 a, double ra, Vec3 b, double rb) {
  const Vec3 ba = b - a, pa = p - a;
  const double l2 = dot(ba, ba), rr = ra - rb, a2 = l2 - rr * rr, il2 = 1 / l2;
  const double y = dot(pa, ba), z = y - l2;
  const Vec3 side = pa * l2 - ba * y;
  const double x2 = dot(side, side), y2 = y * y * l2, z2 = z * z * l2;
  const double k = (rr > 0 ? 1.0 : rr < 0 ? -1.0 : 0.0) * rr * rr * x2;
  if ((z > 0 ? 1.0 : -1.0) * a2 * z2 > k) return std::sqrt(x2 + z2) * il2 - rb;
  if ((y > 0 ? 1.0 : -1.0) * a2 * y2 < k) return std::sqrt(x2 + y2) * il2 - ra;
  return (std::sqrt(x2 * a2 * il2) + y * rr) * il2 - ra;
}

[[nodiscard]] inline double segment_distance(double x, double y, double ax, double ay, double bx,
                                             double by) {
  const double dx = bx - ax, dy = by - ay;
  const double t = std::clamp(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  const double ex = x - ax - t * dx, ey = y - ay - t * dy;
  return std::sqrt(ex * ex + ey * ey);
}

/// A root: an elliptic paraboloid about an upright axis (bent when `axis_x` depends on z), so that
/// its end is round. First-order distance.
[[nodiscard]] inline double paraboloid(Vec3 p, double axis_x, double half_x, double half_y,
                                       double apex_z, double top_z) {
  const double u = (p.x - axis_x) / half_x, v = p.y / half_y, high = top_z - apex_z;
  const double gx = 2 * u / half_x, gy = 2 * v / half_y, gz = 1 / high;
  return (u * u + v * v - (p.z - apex_z) / high) / std::sqrt(gx * gx + gy * gy + gz * gz);
}

}  // namespace cavum
