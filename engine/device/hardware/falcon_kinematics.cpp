#include "engine/device/hardware/falcon_kinematics.h"

#include <algorithm>

namespace cavum {
namespace {

/// The loop of one arm: what its equation leaves, and how that changes with place and angle.
struct Loop {
  double left = 0.0;  // mm²
  Vec3 by_place;      // mm
  double by_angle = 0.0;
  bool closed = false;
};

Loop loop_of(const FalconGeometry& g, std::size_t arm, double angle_rad, Vec3 p) noexcept {
  const SinCos leg = det_sincos(g.leg_rad[arm]), thigh = det_sincos(angle_rad);
  const Vec3 out{leg.cos, leg.sin, 0}, around{-leg.sin, leg.cos, 0};
  const double u = dot(p, out) - g.r + g.c - g.a * thigh.cos, v = dot(p, around) - g.s + g.f,
               w = p.z - g.a * thigh.sin;
  const double shin2 = g.b * g.b - v * v;
  constexpr double k_min_mm2 = 1.0;
  if (!(shin2 > k_min_mm2)) return {};
  const double shin = std::sqrt(shin2), reach = g.links + shin;
  Loop loop;
  loop.closed = true;
  loop.left = u * u + w * w - reach * reach;
  loop.by_place = out * (2 * u) + around * (2 * reach * v / shin) + Vec3{0, 0, 2 * w};
  loop.by_angle = 2 * g.a * (u * thigh.sin - w * thigh.cos);
  return loop;
}

/// Columns of the inverse of the matrix with these rows. False when it has none worth the name.
bool invert(const std::array<Vec3, 3>& rows, std::array<Vec3, 3>& columns) noexcept {
  columns = {cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])};
  const double det = dot(rows[0], columns[0]);
  constexpr double k_least = 1e-4;
  if (!(std::fabs(det) > k_least * length(rows[0]) * length(rows[1]) * length(rows[2])))
    return false;
  for (Vec3& column : columns) column = column / det;
  return true;
}

}  // namespace

bool falcon_angles(const FalconGeometry& g, Vec3 p, FalconAngles& angles_rad) noexcept {
  FalconAngles found{};
  for (std::size_t arm = 0; arm < 3; ++arm) {
    const SinCos leg = det_sincos(g.leg_rad[arm]);
    const double x = p.x * leg.cos + p.y * leg.sin - g.r + g.c,
                 v = p.y * leg.cos - p.x * leg.sin - g.s + g.f;
    const double shin2 = g.b * g.b - v * v;
    if (!(shin2 > 0)) return false;
    const double reach = g.links + std::sqrt(shin2);
    // The knee is where the thigh's circle meets the shin's: across the line to the grip, on the
    // outside.
    const double far2 = x * x + p.z * p.z, far = std::sqrt(far2);
    if (!(far > 0)) return false;
    const double along = (far2 + g.a * g.a - reach * reach) / (2 * far),
                 across2 = g.a * g.a - along * along;
    if (!(across2 >= 0)) return false;
    const double across = std::sqrt(across2);
    const double cosine = (along * x + across * p.z) / (far * g.a),
                 sine = (along * p.z - across * x) / (far * g.a);
    // angle of (cosine, sine) without libm: each turn takes the third power of what is left
    double angle = cosine >= 0 ? sine : (sine >= 0 ? k_pi - sine : -k_pi - sine);
    constexpr int k_turns = 6;
    for (int i = 0; i < k_turns; ++i) {
      const SinCos at = det_sincos(angle);
      angle += sine * at.cos - cosine * at.sin;
    }
    found[arm] = angle;
  }
  angles_rad = found;
  return true;
}

bool falcon_position(const FalconGeometry& g, const FalconAngles& angles_rad,
                     Vec3& position_mm) noexcept {
  constexpr int k_max_steps = 40;
  constexpr double k_longest_step_mm = 20.0, k_close_mm = 1e-10;
  Vec3 p = position_mm;
  for (int i = 0; i < k_max_steps; ++i) {
    std::array<Vec3, 3> rows, columns;
    std::array<double, 3> left{};
    for (std::size_t arm = 0; arm < 3; ++arm) {
      const Loop loop = loop_of(g, arm, angles_rad[arm], p);
      if (!loop.closed) return false;
      rows[arm] = loop.by_place;
      left[arm] = loop.left;
    }
    if (!invert(rows, columns)) return false;
    Vec3 step = -(columns[0] * left[0] + columns[1] * left[1] + columns[2] * left[2]);
    const double size = length(step);
    if (!(size < 1e6)) return false;
    if (size > k_longest_step_mm) step = step * (k_longest_step_mm / size);
    p += step;
    if (size < k_close_mm) {
      if (!(p.z > 0)) return false;  // the other side of the motors: the loops close there too
      position_mm = p;
      return true;
    }
  }
  return false;
}

bool falcon_jacobian(const FalconGeometry& g, const FalconAngles& angles_rad, Vec3 position_mm,
                     std::array<Vec3, 3>& columns) noexcept {
  std::array<Vec3, 3> rows, inverse;
  std::array<double, 3> by_angle{};
  for (std::size_t arm = 0; arm < 3; ++arm) {
    const Loop loop = loop_of(g, arm, angles_rad[arm], position_mm);
    if (!loop.closed) return false;
    rows[arm] = loop.by_place;
    by_angle[arm] = loop.by_angle;
  }
  if (!invert(rows, inverse)) return false;
  for (std::size_t arm = 0; arm < 3; ++arm) columns[arm] = inverse[arm] * -by_angle[arm];
  return true;
}

std::array<double, 3> falcon_torques_nmm(const std::array<Vec3, 3>& columns,
                                         Vec3 force_n) noexcept {
  return {dot(columns[0], force_n), dot(columns[1], force_n), dot(columns[2], force_n)};
}

}  // namespace cavum
