#include "engine/lab/scan/surface_points.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "engine/base/error.h"

namespace cavum {
namespace {

using Corners = std::array<Vec3, 3>;

/// The triangle in halves, across its longest edge each, until no edge is longer: `visit(corners,
/// halvings)`.
template <class Visit>
void halved(const Corners& whole, double longest_mm, const Visit& visit) {
  constexpr int k_max_halvings = 40;
  std::vector<std::pair<Corners, int>> open{{whole, 0}};
  while (!open.empty()) {
    const auto [t, halvings] = open.back();
    open.pop_back();
    std::size_t longest = 0;
    const auto edge = [&](std::size_t i) { return length(t[(i + 1) % 3] - t[i]); };
    for (std::size_t i = 1; i < 3; ++i) longest = edge(i) > edge(longest) ? i : longest;
    if (edge(longest) <= longest_mm || halvings == k_max_halvings) {
      visit(t, halvings);
      continue;
    }
    const Vec3 a = t[longest], b = t[(longest + 1) % 3], c = t[(longest + 2) % 3],
               middle = (a + b) * 0.5;
    open.push_back({{a, middle, c}, halvings + 1});
    open.push_back({{middle, b, c}, halvings + 1});
  }
}

}  // namespace

std::vector<SurfacePoint> surface_points(const TriangleMesh& mesh, double longest_mm,
                                         const Where& where) {
  std::vector<SurfacePoint> points;
  points.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const Corners whole{mesh.vertices_mm[t[0]], mesh.vertices_mm[t[1]], mesh.vertices_mm[t[2]]};
    const Vec3 across = cross(whole[1] - whole[0], whole[2] - whole[0]);
    const double twice = length(across);
    if (!(twice > 1e-12)) continue;
    halved(whole, longest_mm, [&](const Corners& part, int halvings) {
      if (points.size() >= k_max_scan_points)
        throw Error(where, msg("its triangles cover more than {} places", k_max_scan_points),
                    msg("check the unit, and that it is the surface of one tooth"));
      points.push_back({(part[0] + part[1] + part[2]) / 3, across / twice,
                        0.5 * twice / static_cast<double>(std::uint64_t{1} << halvings)});
    });
  }
  return points;
}

std::vector<SurfacePoint> drawn_by_area(const std::vector<SurfacePoint>& points, std::size_t count,
                                        Random& random) {
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
    const Vec3 a = mesh.vertices_mm[t[0]],
               across = cross(mesh.vertices_mm[t[1]] - a, mesh.vertices_mm[t[2]] - a);
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
