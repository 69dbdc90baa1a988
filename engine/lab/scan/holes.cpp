#include "engine/lab/scan/holes.h"

#include <algorithm>

namespace cavum {

std::vector<Rim> rims_of(const TriangleMesh& mesh) {
  using Edge = std::array<std::uint32_t, 2>;
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) edges.push_back({t[i], t[(i + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  std::vector<Edge> open;  // those that fewer triangles run the other way
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    for (end = i; end < edges.size() && edges[end] == edges[i];) ++end;
    const auto [first, last] =
        std::equal_range(edges.begin(), edges.end(), Edge{edges[i][1], edges[i][0]});
    for (auto n = static_cast<std::ptrdiff_t>(end - i); n > last - first; --n)
      open.push_back(edges[i]);
  }
  std::vector<bool> used(open.size(), false);
  std::vector<Rim> rims;
  for (std::size_t first = 0; first < open.size(); ++first) {
    if (used[first]) continue;
    Rim rim;
    for (std::size_t at = first; at < open.size();) {
      used[at] = true;
      const auto [from, to] = open[at];
      rim.corners.push_back(from);
      rim.length_mm += length(mesh.vertices_mm[to] - mesh.vertices_mm[from]);
      rim.middle_mm += mesh.vertices_mm[from];
      auto next = static_cast<std::size_t>(std::lower_bound(open.begin(), open.end(), Edge{to, 0}) -
                                           open.begin());
      while (next < open.size() && open[next][0] == to && used[next]) ++next;
      at = next < open.size() && open[next][0] == to ? next : open.size();
    }
    rim.middle_mm = rim.middle_mm / static_cast<double>(rim.corners.size());
    rims.push_back(std::move(rim));
  }
  std::stable_sort(rims.begin(), rims.end(),
                   [](const Rim& a, const Rim& b) { return a.length_mm > b.length_mm; });
  return rims;
}

TriangleMesh caps_over(const TriangleMesh& mesh, const std::vector<Rim>& rims) {
  TriangleMesh caps;
  for (const Rim& rim : rims) {
    const auto middle = static_cast<std::uint32_t>(caps.vertices_mm.size()), first = middle + 1,
               n = static_cast<std::uint32_t>(rim.corners.size());
    caps.vertices_mm.push_back(rim.middle_mm);
    for (const auto c : rim.corners) caps.vertices_mm.push_back(mesh.vertices_mm[c]);
    for (std::uint32_t i = 0; i < n; ++i)
      caps.triangles.push_back({middle, first + (i + 1) % n, first + i});
  }
  return caps;
}

}  // namespace cavum
