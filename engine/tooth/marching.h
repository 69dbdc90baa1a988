// Template of the marching tetrahedra. Included by surface_mesh.h only.
#pragma once

#include <algorithm>

#include "engine/tooth/surface_mesh.h"

namespace cavum {
namespace marching {

/// Corner c of a cell has offset (c & 1, c >> 1 & 1, c >> 2). Six tetrahedra around the diagonal 0-7, each
/// positively oriented.
inline constexpr std::array<std::array<int, 4>, 6> k_tetrahedra{{{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

/// Orders a tetrahedron so that its inside corners come first and its orientation is kept.
/// Returns how many corners are inside.
inline int inside_first(std::array<int, 4>& corner, const std::array<bool, 8>& in) {
  int count = 0;
  bool odd = false;
  for (int i = 0; i < 4; ++i)
    if (in[static_cast<std::size_t>(corner[static_cast<std::size_t>(i)])]) {
      for (int j = i; j > count; --j) {
        std::swap(corner[static_cast<std::size_t>(j)], corner[static_cast<std::size_t>(j - 1)]);
        odd = !odd;
      }
      ++count;
    }
  if (odd) count >= 2 ? std::swap(corner[0], corner[1]) : std::swap(corner[2], corner[3]);
  return count;
}

}  // namespace marching

template <class Fraction>
TriangleMesh march_tetrahedra(IVec3 size, Vec3 first_mm, double step_mm, std::span<const std::uint8_t> inside, const Fraction& fraction) {
  constexpr std::size_t k_most_triangles = 8'000'000;  // a molar at a leaf of 0.025 mm has 4 million; some 100 bytes each
  TriangleMesh mesh;
  const auto nx = static_cast<std::size_t>(size.x), ny = static_cast<std::size_t>(size.y);
  const std::array<std::size_t, 8> corner_step{0, 1, nx, nx + 1, nx * ny, nx * ny + 1, nx * ny + nx, nx * ny + nx + 1};
  // An edge is known by its lower point and its direction (1..7); two layers of them are enough.
  std::array<std::vector<std::uint32_t>, 2> edges;
  for (auto& layer : edges) layer.assign(nx * ny * 8, ~0u);
  for (std::int32_t z = 0; z + 1 < size.z; ++z) {
    std::fill(edges[static_cast<std::size_t>((z + 1) & 1)].begin(), edges[static_cast<std::size_t>((z + 1) & 1)].end(), ~0u);
    for (std::int32_t y = 0; y + 1 < size.y; ++y) {
      const std::size_t row = (static_cast<std::size_t>(z) * ny + static_cast<std::size_t>(y)) * nx;
      for (std::int32_t x = 0; x + 1 < size.x; ++x) {
        const std::size_t base = row + static_cast<std::size_t>(x);
        std::array<bool, 8> in{};
        int filled = 0;
        for (std::size_t c = 0; c < 8; ++c) {
          in[c] = inside[base + corner_step[c]] != 0;
          filled += in[c];
        }
        if (filled == 0 || filled == 8) continue;
        if (mesh.triangles.size() > k_most_triangles)
          throw Error("surface", "has more than " + std::to_string(k_most_triangles) + " triangles", "use a tooth with larger leaves");
        const auto at = [&](int c) { return IVec3{x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)}; };
        const auto crossing = [&](int p, int q) {  // p inside, q outside
          const int low = std::min(p, q), direction = p ^ q;
          const IVec3 l = at(low);
          auto& slot = edges[static_cast<std::size_t>(l.z & 1)]
                            [(static_cast<std::size_t>(l.y) * nx + static_cast<std::size_t>(l.x)) * 8 + static_cast<std::size_t>(direction)];
          if (slot == ~0u) {
            slot = static_cast<std::uint32_t>(mesh.vertices_mm.size());
            const IVec3 a = at(p), b = at(q);
            const double t = fraction(a, b);
            const Vec3 from{double(a.x), double(a.y), double(a.z)}, to{double(b.x), double(b.y), double(b.z)};
            mesh.vertices_mm.push_back(first_mm + (from + (to - from) * t) * step_mm);
          }
          return slot;
        };
        for (auto t : marching::k_tetrahedra) {
          switch (marching::inside_first(t, in)) {
            case 1:
              mesh.triangles.push_back({crossing(t[0], t[1]), crossing(t[0], t[2]), crossing(t[0], t[3])});
              break;
            case 2: {
              const std::array<std::uint32_t, 4> q{crossing(t[0], t[2]), crossing(t[0], t[3]), crossing(t[1], t[3]), crossing(t[1], t[2])};
              mesh.triangles.push_back({q[0], q[1], q[2]});
              mesh.triangles.push_back({q[0], q[2], q[3]});
              break;
            }
            case 3:
              mesh.triangles.push_back({crossing(t[0], t[3]), crossing(t[1], t[3]), crossing(t[2], t[3])});
              break;
            default:
              break;
          }
        }
      }
    }
  }
  return mesh;
}

}  // namespace cavum
