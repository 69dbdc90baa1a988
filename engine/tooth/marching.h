// Marching tetrahedra: the closed surface between the points of a lattice that are in a body and
// those that are not.
#pragma once

#include <fmt/core.h>

#include <algorithm>

#include "engine/tooth/surface_mesh.h"

namespace cavum {
namespace marching {

/// Corner c of a cell has offset (c & 1, c >> 1 & 1, c >> 2). Six tetrahedra around the diagonal
/// 0-7, each positively oriented.
inline constexpr std::array<std::array<int, 4>, 6> k_tetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

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

/// Vertices on the edges between the points of a lattice, each made once. An edge is known by its
/// lower point and its direction (1..7); two layers of them are enough.
template <class Fraction>
class EdgeVertices {
 public:
  EdgeVertices(IVec3 size, Vec3 first_mm, double step_mm, const Fraction& fraction,
               std::vector<Vec3>& vertices_mm)
      : nx_(static_cast<std::size_t>(size.x)),
        first_mm_(first_mm),
        step_mm_(step_mm),
        fraction_(fraction),
        vertices_mm_(vertices_mm) {
    for (auto& layer : layers_) layer.assign(nx_ * static_cast<std::size_t>(size.y) * 8, k_none);
  }

  /// Cells of layer z come next: what is known of the edges that begin two layers before is
  /// forgotten.
  void begin_layer(std::int32_t z) {
    std::fill(layer_of(z + 1).begin(), layer_of(z + 1).end(), k_none);
  }

  /// The vertex on the edge between corner p of a cell, which is inside, and corner q, which is
  /// not.
  std::uint32_t between(IVec3 cell, int p, int q) {
    const IVec3 low = corner(cell, std::min(p, q));
    auto& vertex = layer_of(
        low.z)[(static_cast<std::size_t>(low.y) * nx_ + static_cast<std::size_t>(low.x)) * 8 +
               static_cast<std::size_t>(p ^ q)];
    if (vertex == k_none) {
      vertex = static_cast<std::uint32_t>(vertices_mm_.size());
      const IVec3 a = corner(cell, p), b = corner(cell, q);
      const double t = fraction_(a, b);
      const Vec3 from{double(a.x), double(a.y), double(a.z)},
          to{double(b.x), double(b.y), double(b.z)};
      vertices_mm_.push_back(first_mm_ + (from + (to - from) * t) * step_mm_);
    }
    return vertex;
  }

 private:
  static constexpr std::uint32_t k_none = ~0u;
  static IVec3 corner(IVec3 cell, int c) {
    return {cell.x + (c & 1), cell.y + (c >> 1 & 1), cell.z + (c >> 2)};
  }
  std::vector<std::uint32_t>& layer_of(std::int32_t z) {
    return layers_[static_cast<std::size_t>(z & 1)];
  }

  std::size_t nx_;
  Vec3 first_mm_;
  double step_mm_;
  const Fraction& fraction_;
  std::vector<Vec3>& vertices_mm_;
  std::array<std::vector<std::uint32_t>, 2> layers_;
};

/// The part of the surface that passes through one cell, whose corners are `in` or not.
template <class Edges>
void add_cell(IVec3 cell, const std::array<bool, 8>& in, Edges& edges,
              std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const auto on = [&](int p, int q) { return edges.between(cell, p, q); };
  for (auto t : k_tetrahedra) {
    switch (inside_first(t, in)) {
      case 1:
        triangles.push_back({on(t[0], t[1]), on(t[0], t[2]), on(t[0], t[3])});
        break;
      case 2: {
        const std::array<std::uint32_t, 4> q{on(t[0], t[2]), on(t[0], t[3]), on(t[1], t[3]),
                                             on(t[1], t[2])};
        triangles.push_back({q[0], q[1], q[2]});
        triangles.push_back({q[0], q[2], q[3]});
        break;
      }
      case 3:
        triangles.push_back({on(t[0], t[3]), on(t[1], t[3]), on(t[2], t[3])});
        break;
      default:
        break;
    }
  }
}

}  // namespace marching

/// Marching tetrahedra over a lattice of points, x fastest. `inside[i]` != 0 marks points in the
/// body; the lattice's outermost points must be outside. `fraction(a, b)` places the crossing
/// between a (inside) and b (outside), 0 at a, 1 at b, exclusive. Point (i,j,k) lies at first_mm +
/// step_mm·(i,j,k).
template <class Fraction>
[[nodiscard]] TriangleMesh march_tetrahedra(IVec3 size, Vec3 first_mm, double step_mm,
                                            std::span<const std::uint8_t> inside,
                                            const Fraction& fraction) {
  constexpr std::size_t k_max_triangles =
      8'000'000;  // a molar at a leaf of 0.025 mm has 4 million; some 100 bytes each
  TriangleMesh mesh;
  const auto nx = static_cast<std::size_t>(size.x), ny = static_cast<std::size_t>(size.y);
  const std::array<std::size_t, 8> corner_step{
      0, 1, nx, nx + 1, nx * ny, nx * ny + 1, nx * ny + nx, nx * ny + nx + 1};
  marching::EdgeVertices edges(size, first_mm, step_mm, fraction, mesh.vertices_mm);
  for (std::int32_t z = 0; z + 1 < size.z; ++z) {
    edges.begin_layer(z);
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
        if (mesh.triangles.size() > k_max_triangles)
          throw Error(msg("surface"), msg("has more than {} triangles", k_max_triangles),
                      msg("use a tooth with larger leaves"));
        marching::add_cell({x, y, z}, in, edges, mesh.triangles);
      }
    }
  }
  return mesh;
}

}  // namespace cavum
