// Small vectors for the physics. Plain arithmetic only, so that the same source gives the same bits
// with every compiler; GLM is kept for the screen, where bits do not matter.
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace cavum {

/// Three doubles; unit as the name of the variable says (mm, N, mm/s).
struct Vec3 {
  double x = 0.0, y = 0.0, z = 0.0;

  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend constexpr Vec3 operator-(Vec3 a) noexcept { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, double s) noexcept { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(double s, Vec3 a) noexcept { return a * s; }
  friend constexpr Vec3 operator/(Vec3 a, double s) noexcept { return {a.x / s, a.y / s, a.z / s}; }
  constexpr Vec3& operator+=(Vec3 b) noexcept { return *this = *this + b; }
  constexpr Vec3& operator-=(Vec3 b) noexcept { return *this = *this - b; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

[[nodiscard]] constexpr double dot(Vec3 a, Vec3 b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] constexpr Vec3 cross(Vec3 a, Vec3 b) noexcept {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// sqrt is correctly rounded everywhere, so length is reproducible.
[[nodiscard]] inline double length(Vec3 a) noexcept { return std::sqrt(dot(a, a)); }
/// Unit vector along `a`; `fallback` when `a` is shorter than 1e-12.
[[nodiscard]] inline Vec3 normalized(Vec3 a, Vec3 fallback = {0, 0, 1}) noexcept {
  const double n = length(a);
  return n > 1e-12 ? a / n : fallback;
}
/// Component by component.
[[nodiscard]] constexpr Vec3 min(Vec3 a, Vec3 b) noexcept {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
[[nodiscard]] constexpr Vec3 max(Vec3 a, Vec3 b) noexcept {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
[[nodiscard]] inline bool is_finite(Vec3 a) noexcept {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Integer leaf coordinates.
struct IVec3 {
  std::int32_t x = 0, y = 0, z = 0;

  friend constexpr IVec3 operator+(IVec3 a, IVec3 b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr IVec3 operator-(IVec3 a, IVec3 b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend constexpr bool operator==(const IVec3&, const IVec3&) = default;
  friend constexpr auto operator<=>(const IVec3&, const IVec3&) = default;
};

[[nodiscard]] constexpr IVec3 min(IVec3 a, IVec3 b) noexcept {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
[[nodiscard]] constexpr IVec3 max(IVec3 a, IVec3 b) noexcept {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
[[nodiscard]] constexpr Vec3 to_vec3(IVec3 a) noexcept {
  return {double(a.x), double(a.y), double(a.z)};
}
/// Whether a lattice of this size has such a cell; how many it has; and where that cell stands
/// among them, x fastest.
[[nodiscard]] constexpr bool lies_in(IVec3 at, IVec3 size) noexcept {
  return at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < size.x && at.y < size.y && at.z < size.z;
}
[[nodiscard]] constexpr std::size_t cells_of(IVec3 size) noexcept {
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
         static_cast<std::size_t>(size.z);
}
[[nodiscard]] constexpr std::size_t cell_index(IVec3 at, IVec3 size) noexcept {
  return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(size.y) +
          static_cast<std::size_t>(at.y)) *
             static_cast<std::size_t>(size.x) +
         static_cast<std::size_t>(at.x);
}

/// The box around all that was added; `low` is above `high` before that.
template <class V>
struct BoundsOf {
  static constexpr auto k_far = std::numeric_limits<decltype(V::x)>::max() / 4;
  V low{k_far, k_far, k_far}, high{-k_far, -k_far, -k_far};
  constexpr void add(V from, V to) noexcept { low = min(low, from), high = max(high, to); }
  constexpr void add(V at) noexcept { add(at, at); }
  [[nodiscard]] constexpr bool empty() const noexcept { return low.x > high.x; }
};
using Bounds = BoundsOf<Vec3>;
using LeafBounds = BoundsOf<IVec3>;

}  // namespace cavum
