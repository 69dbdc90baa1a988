#include <algorithm>
#include <cmath>

#include "engine/tooth/anatomy/occlusal_marks.h"
#include "engine/tooth/anatomy/polylines.h"

namespace cavum {
namespace {
constexpr double k_edge_band_mm = 0.7;  // below the highest place: the edge's corners are round
constexpr double k_slice_mm = 0.3;
}  // namespace

Polyline find_incisal_edge(const CrownMaps& maps) {
  const HeightMap& map = maps.fissures;
  double top = -1e9;
  for (int c = 0; c < map.count(); ++c)
    if (map.on[static_cast<std::size_t>(c)] != 0) top = std::max(top, map.at(c));
  // the direction in which the places near the top spread most
  double n = 0, sx = 0, sy = 0, xx = 0, xy = 0, yy = 0;
  std::vector<int> high;
  for (int c = 0; c < map.count(); ++c) {
    if (map.on[static_cast<std::size_t>(c)] == 0 || map.at(c) < top - k_edge_band_mm) continue;
    const Vec3 p = map.place(c);
    high.push_back(c);
    n += 1;
    sx += p.x;
    sy += p.y;
    xx += p.x * p.x;
    xy += p.x * p.y;
    yy += p.y * p.y;
  }
  if (n < 10) return {};
  const Vec3 middle{sx / n, sy / n, 0};
  const double a = xx / n - middle.x * middle.x, b = xy / n - middle.x * middle.y,
               c = yy / n - middle.y * middle.y;
  const double root = std::sqrt(0.25 * (a - c) * (a - c) + b * b), large = 0.5 * (a + c) + root;
  Vec3 along = normalized({b, large - a, 0}, {1, 0, 0});
  if (std::fabs(b) < 1e-12) along = a >= c ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  if (along.x < 0) along = -along;
  const Vec3 across{-along.y, along.x, 0};
  double low = 1e9, far = -1e9;
  for (const int cell : high) {
    const double u = dot(map.place(cell) - middle, along);
    low = std::min(low, u);
    far = std::max(far, u);
  }
  Polyline edge;
  for (double u = far; u >= low; u -= k_slice_mm) {
    Vec3 best{0, 0, -1e9};
    for (double v = -3.0; v <= 3.0; v += 0.5 * HeightMap::k_cell_mm) {
      const Vec3 p = middle + along * u + across * v;
      if (const double z = map.height(p.x, p.y); z > best.z) best = {p.x, p.y, z};
    }
    if (best.z >= top - k_edge_band_mm) edge.push_back(best);
  }
  for (int pass = 0; pass < 2 && edge.size() > 2; ++pass) {
    const Polyline old = edge;
    for (std::size_t i = 1; i + 1 < edge.size(); ++i)
      edge[i] = old[i - 1] * 0.25 + old[i] * 0.5 + old[i + 1] * 0.25;
  }
  for (auto& p : edge) p.z = map.height(p.x, p.y);
  return edge;
}

}  // namespace cavum
