// Small vectors for the physics. Plain arithmetic only, so that the same source gives the same bits
// with every compiler; GLM is kept for the screen, where bits do not matter.
#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

namespace cavum {

/// Three doubles; unit as the name of the variable says (mm, N, mm/s).
struct Vec3 {
  double x = 0.0, y = 0.0, z = 0.0;

  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(Vec3 a) noexcept { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, double s) noexcept { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(double s, Vec3 a) noexcept { return a * s; }
  friend constexpr Vec3 operator/(Vec3 a, double s) noexcept { return {a.x / s, a.y / s, a.z / s}; }
  constexpr Vec3& operator+=(Vec3 b) noexcept { return *this = *this + b; }
  constexpr Vec3& operator-=(Vec3 b) noexcept { return *this = *this - b; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

[[nodiscard]] constexpr double dot(Vec3 a, Vec3 b) noexcept { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] constexpr Vec3 cross(Vec3 a, Vec3 b) noexcept { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
/// sqrt is correctly rounded everywhere, so length is reproducible.
[[nodiscard]] inline double length(Vec3 a) noexcept { return std::sqrt(dot(a, a)); }
/// Unit vector along `a`; `fallback` when `a` is shorter than 1e-12.
[[nodiscard]] inline Vec3 normalized(Vec3 a, Vec3 fallback = {0, 0, 1}) noexcept {
  const double n = length(a);
  return n > 1e-12 ? a / n : fallback;
}
[[nodiscard]] inline bool is_finite(Vec3 a) noexcept { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// Integer leaf coordinates.
struct IVec3 {
  std::int32_t x = 0, y = 0, z = 0;

  friend constexpr IVec3 operator+(IVec3 a, IVec3 b) noexcept { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr IVec3 operator-(IVec3 a, IVec3 b) noexcept { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr bool operator==(const IVec3&, const IVec3&) = default;
  friend constexpr auto operator<=>(const IVec3&, const IVec3&) = default;
};

}  // namespace cavum
