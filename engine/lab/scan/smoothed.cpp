#include "engine/lab/scan/smoothed.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cavum {
namespace {

/// Points in cells as wide as the radius: those around a place lie in 27 of them.
class Neighbours {
 public:
  Neighbours(const std::vector<SurfacePoint>& points, double radius_mm) : radius_mm_(radius_mm) {
    Bounds box;
    for (const auto& p : points) box.add(p.at_mm);
    cell_mm_ = radius_mm;
    constexpr double k_max_cells = 8e6;
    const auto along = [&](double mm) { return std::floor(mm / cell_mm_) + 1; };
    while (along(box.high.x - box.low.x) * along(box.high.y - box.low.y) *
               along(box.high.z - box.low.z) >
           k_max_cells)
      cell_mm_ *= 1.25;
    low_mm_ = box.low;
    size_ = {static_cast<int>(along(box.high.x - box.low.x)),
             static_cast<int>(along(box.high.y - box.low.y)),
             static_cast<int>(along(box.high.z - box.low.z))};
    first_.assign(cells_of(size_) + 1, 0);
    for (const auto& p : points) ++first_[index(cell_of(p.at_mm)) + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    sorted_.resize(points.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const auto& p : points) sorted_[next[index(cell_of(p.at_mm))]++] = p;
  }
  /// Calls `visit(point, r²)` for each point within the radius of `at`; r: its distance over the
  /// radius.
  template <class Visit>
  void around(Vec3 at, const Visit& visit) const {
    const IVec3 c = cell_of(at);
    for (int z = std::max(c.z - 1, 0); z <= std::min(c.z + 1, size_.z - 1); ++z)
      for (int y = std::max(c.y - 1, 0); y <= std::min(c.y + 1, size_.y - 1); ++y) {
        const std::size_t from = index({std::max(c.x - 1, 0), y, z}),
                          to = index({std::min(c.x + 1, size_.x - 1), y, z});
        for (std::size_t i = first_[from]; i < first_[to + 1]; ++i) {
          const Vec3 off = at - sorted_[i].at_mm;
          const double squared = dot(off, off) / (radius_mm_ * radius_mm_);
          if (squared < 1.0) visit(sorted_[i], off, squared);
        }
      }
  }

 private:
  [[nodiscard]] IVec3 cell_of(Vec3 p) const noexcept {
    const Vec3 q = (p - low_mm_) / cell_mm_;
    const auto within = [](double v, int n) {
      return v > 0 ? std::min(static_cast<int>(v), n - 1) : 0;
    };
    return {within(q.x, size_.x), within(q.y, size_.y), within(q.z, size_.z)};
  }
  [[nodiscard]] std::size_t index(IVec3 c) const noexcept { return cell_index(c, size_); }

  double radius_mm_, cell_mm_ = 1.0;
  Vec3 low_mm_;
  IVec3 size_;
  std::vector<std::size_t> first_;
  std::vector<SurfacePoint> sorted_;
};

/// The implicit function at a place: its value, mm, and its gradient.
struct Implicit {
  double value_mm = 0.0;
  Vec3 gradient;
  bool known = false;
};

Implicit implicit_at(Vec3 at, const Neighbours& neighbours, double radius_mm) {
  constexpr int k_passes = 3;
  constexpr double k_apart = 0.7;  // of unit normals, from which on they count less
  const double off_mm = 0.25 * radius_mm;
  Implicit f;
  for (int round = 0; round < k_passes; ++round) {
    double weights = 0, values = 0;
    Vec3 slopes, slopes_of_values, normals;
    neighbours.around(at, [&](const SurfacePoint& p, Vec3 off, double r2) {
      const double plane = dot(off, p.normal), left = 1 - r2;
      double alpha = p.area_mm2;
      if (round > 0) {
        const double a = (plane - f.value_mm) / off_mm;
        const Vec3 turn = (p.normal - f.gradient) / k_apart;
        const double b = 1 + a * a, c = 1 + dot(turn, turn);
        alpha /= b * b * c * c;
      }
      const double w = alpha * left * left * left * left;
      const Vec3 slope =
          off * (-8 * alpha * left * left * left / (radius_mm * radius_mm));  // of the weight
      weights += w;
      values += w * plane;
      slopes += slope;
      slopes_of_values += slope * plane;
      normals += p.normal * w;
    });
    if (!(weights > 1e-12)) return f;
    f.value_mm = values / weights;
    f.gradient = (slopes_of_values - slopes * f.value_mm + normals) / weights;
    f.known = true;
  }
  return f;
}

/// The points with the normals of what lies around them, those alike more than others.
std::vector<SurfacePoint> with_even_normals(std::vector<SurfacePoint> points, double radius_mm) {
  constexpr double k_alike[] = {1.4,
                                0.7};  // of unit normals: from which difference on they count less
  for (const double alike : k_alike) {
    const Neighbours neighbours(points, radius_mm);
    for (SurfacePoint& point : points) {
      Vec3 sum;
      neighbours.around(point.at_mm, [&](const SurfacePoint& p, Vec3, double r2) {
        const Vec3 turn = (p.normal - point.normal) / alike;
        const double left = 1 - r2, c = 1 + dot(turn, turn);
        sum += p.normal * (p.area_mm2 * left * left * left * left / (c * c));
      });
      point.normal = normalized(sum * 1e6, point.normal);
    }
  }
  return points;
}

}  // namespace

TriangleMesh smoothed(const TriangleMesh& mesh, const std::vector<SurfacePoint>& points,
                      const std::vector<std::uint8_t>& wanted, double radius_mm) {
  constexpr int k_steps = 2;
  TriangleMesh out = mesh;
  if (points.empty()) return out;
  const Neighbours neighbours(with_even_normals(points, radius_mm), radius_mm);
  for (std::size_t i = 0; i < out.vertices_mm.size(); ++i)
    for (int step = 0; step < k_steps && wanted[i] != 0; ++step) {
      Vec3& v = out.vertices_mm[i];
      const Implicit f = implicit_at(v, neighbours, radius_mm);
      const double steep = dot(f.gradient, f.gradient);
      if (!f.known || !(steep > 0.25)) break;
      v -= f.gradient * (f.value_mm / steep);
    }
  return out;
}

}  // namespace cavum
