#include "engine/tooth/import/hollows.h"

#include <algorithm>
#include <cmath>

namespace cavum {

std::vector<std::uint8_t> hollows(const TriangleMesh& mesh_mm, const std::vector<float>& filled,
                                  const TissueGrid& lattice) {
  const IVec3 size = lattice.size;
  std::vector<std::vector<double>> crossings(static_cast<std::size_t>(size.x) *
                                             static_cast<std::size_t>(size.y));
  // a little beside the leaves' middles, so that no column runs along an edge of meshes that were
  // made on a lattice
  constexpr double k_beside_x = 0.0137, k_beside_y = 0.0071;
  const Vec3 first =
      lattice.centre_mm({0, 0, 0}) + Vec3{k_beside_x, k_beside_y, 0} * lattice.leaf_mm;
  const auto in_leaves = [&](Vec3 mm) { return (mm - first) / lattice.leaf_mm; };
  for (const auto& t : mesh_mm.triangles) {
    const Vec3 a = in_leaves(mesh_mm.vertices_mm[t[0]]), b = in_leaves(mesh_mm.vertices_mm[t[1]]),
               c = in_leaves(mesh_mm.vertices_mm[t[2]]);
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (area == 0) continue;
    const auto low = [](double v) { return std::max(0, static_cast<int>(std::ceil(v))); };
    const auto high = [](double v, int n) {
      return std::min(n - 1, static_cast<int>(std::floor(v)));
    };
    for (int y = low(std::min({a.y, b.y, c.y})); y <= high(std::max({a.y, b.y, c.y}), size.y); ++y)
      for (int x = low(std::min({a.x, b.x, c.x})); x <= high(std::max({a.x, b.x, c.x}), size.x);
           ++x) {
        const double u = ((b.x - x) * (c.y - y) - (c.x - x) * (b.y - y)) / area,
                     v = ((c.x - x) * (a.y - y) - (a.x - x) * (c.y - y)) / area, w = 1.0 - u - v;
        if (u >= 0 && v >= 0 && w >= 0)
          crossings[static_cast<std::size_t>(y * size.x + x)].push_back(u * a.z + v * b.z +
                                                                        w * c.z);
      }
  }
  std::vector<std::uint8_t> hollow(lattice.count(), 0);
  constexpr float k_on_surface = 0.01F;  // leaves: what lies on it is neither within nor without
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      auto& heights = crossings[static_cast<std::size_t>(y * size.x + x)];
      if (heights.size() % 2 != 0) continue;
      std::sort(heights.begin(), heights.end());
      std::size_t below = 0;
      for (int z = 0; z < size.z; ++z) {
        while (below < heights.size() && heights[below] < z) ++below;
        const std::size_t i = lattice.index({x, y, z});
        hollow[i] = filled[i] < -k_on_surface && below % 2 == 0;
      }
    }
  return hollow;
}

}  // namespace cavum
