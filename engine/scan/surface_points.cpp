#include "engine/scan/surface_points.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"

namespace cavum {
namespace {

constexpr double k_most_points = 20e6;

}  // namespace

std::vector<SurfacePoint> surface_points(const TriangleMesh& mesh, double longest_mm, const std::string& where) {
  std::vector<SurfacePoint> points;
  points.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices_mm[t[0]], ab = mesh.vertices_mm[t[1]] - a, ac = mesh.vertices_mm[t[2]] - a;
    const Vec3 across = cross(ab, ac);
    const double twice = length(across);
    if (!(twice > 1e-12)) continue;
    const double parts = std::max(1.0, std::ceil(std::max({length(ab), length(ac), length(ac - ab)}) / longest_mm));
    if (static_cast<double>(points.size()) + parts * parts > k_most_points)
      throw Error(where, fmt::format("its triangles cover more than {} places", static_cast<long>(k_most_points)),
                  "check the unit, and that it is the surface of one tooth");
    const auto n = static_cast<int>(parts);
    const SurfacePoint one{{}, across / twice, 0.5 * twice / (parts * parts)};
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        points.push_back(one);
        points.back().at_mm = a + ab * ((i + 1.0 / 3) / n) + ac * ((j + 1.0 / 3) / n);
        if (i + j + 1 >= n) continue;
        points.push_back(one);
        points.back().at_mm = a + ab * ((i + 2.0 / 3) / n) + ac * ((j + 2.0 / 3) / n);
      }
  }
  return points;
}

std::vector<SurfacePoint> drawn_by_area(const std::vector<SurfacePoint>& points, std::size_t count, Random& random) {
  std::vector<SurfacePoint> drawn;
  drawn.reserve(count);
  const double step = area_of(points) / static_cast<double>(count);
  double sum = 0, next = step * random.uniform();
  for (const auto& p : points) {
    sum += p.area_mm2;
    for (; next < sum && drawn.size() < count; next += step) {
      drawn.push_back(p);
      drawn.back().area_mm2 = step;
    }
  }
  return drawn;
}

std::vector<Vec3> corner_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices_mm.size());
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices_mm[t[0]], across = cross(mesh.vertices_mm[t[1]] - a, mesh.vertices_mm[t[2]] - a);
    for (const auto i : t) normals[i] += across;
  }
  for (Vec3& n : normals) n = length(n) > 0 ? n / length(n) : Vec3{0, 0, 1};
  return normals;
}

double area_of(const std::vector<SurfacePoint>& points) noexcept {
  double sum = 0;
  for (const auto& p : points) sum += p.area_mm2;
  return sum;
}

}  // namespace cavum
