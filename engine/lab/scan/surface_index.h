// The nearest place of a surface, looked up in a lattice: coarse (about a cell), and quick enough
// for thousands of trial poses.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/lab/scan/surface_points.h"

namespace cavum {

class SurfaceIndex {
 public:
  struct Place {
    Vec3 at_mm, normal;  ///< a point of the surface, and the mean unit normal of its cell
    /// Signed distance of `p` from the plane there, mm, positive outside.
    [[nodiscard]] double plane_mm(Vec3 p) const noexcept { return dot(p - at_mm, normal); }
  };
  SurfaceIndex() = default;
  /// Points, one at least, in cells of `cell_mm`, and `margin_mm` around all of them. The cells
  /// grow where there would be more than four million.
  SurfaceIndex(const std::vector<SurfacePoint>& points, double cell_mm, double margin_mm);
  /// Some place about as near as the nearest; beyond the margin the one that is nearest to the
  /// nearest place within it.
  [[nodiscard]] const Place& near(Vec3 p) const noexcept {
    return places_[static_cast<std::size_t>(cells_[cell_of(p)])];
  }

 private:
  [[nodiscard]] std::size_t cell_of(Vec3 p) const noexcept {
    const auto within = [](double v, std::int32_t n) {
      return v > 0 ? static_cast<std::size_t>(v < n - 1 ? v : n - 1) : std::size_t{0};
    };
    const Vec3 q = (p - low_mm_) / cell_mm_;
    return (within(q.z, size_.z) * static_cast<std::size_t>(size_.y) + within(q.y, size_.y)) *
               static_cast<std::size_t>(size_.x) +
           within(q.x, size_.x);
  }
  [[nodiscard]] Vec3 centre_of(std::size_t cell) const noexcept {
    const auto nx = static_cast<std::size_t>(size_.x), ny = static_cast<std::size_t>(size_.y);
    return low_mm_ + Vec3{static_cast<double>(cell % nx) + 0.5,
                          static_cast<double>(cell / nx % ny) + 0.5,
                          static_cast<double>(cell / (nx * ny)) + 0.5} *
                         cell_mm_;
  }

  double cell_mm_ = 1.0;
  Vec3 low_mm_;
  IVec3 size_;
  std::vector<std::int32_t> cells_;  // x fastest: place of each
  std::vector<Place> places_;
};

}  // namespace cavum
