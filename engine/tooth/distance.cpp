#include "engine/tooth/distance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/tooth/marching.h"

namespace cavum {
namespace {

constexpr int k_reach = 3;  // leaves around a surface that may still lie in the band

/// Squared distance (in leaves) from every leaf to the nearest leaf of the other kind, up to
/// k_reach along each axis; 255 beyond.
std::vector<std::uint8_t> squared_to_other_kind(const TissueGrid& grid,
                                                const std::vector<std::uint8_t>& solid) {
  std::vector<std::uint8_t> squared(grid.count(), 255);
  const std::size_t nx = static_cast<std::size_t>(grid.size.x),
                    nxy = nx * static_cast<std::size_t>(grid.size.y);
  for (std::int32_t z = 0; z < grid.size.z; ++z)
    for (std::int32_t y = 0; y < grid.size.y; ++y)
      for (std::int32_t x = 0; x < grid.size.x; ++x) {
        const IVec3 l{x, y, z};
        const std::size_t i = grid.index(l);
        const auto kind = solid[i];
        const bool border =
            (x > 0 && solid[i - 1] != kind) || (x + 1 < grid.size.x && solid[i + 1] != kind) ||
            (y > 0 && solid[i - nx] != kind) || (y + 1 < grid.size.y && solid[i + nx] != kind) ||
            (z > 0 && solid[i - nxy] != kind) || (z + 1 < grid.size.z && solid[i + nxy] != kind);
        if (!border)
          continue;  // the nearest leaf of the other kind always touches a face of its border
        for (int dz = -k_reach; dz <= k_reach; ++dz)
          for (int dy = -k_reach; dy <= k_reach; ++dy)
            for (int dx = -k_reach; dx <= k_reach; ++dx) {
              const IVec3 n{x + dx, y + dy, z + dz};
              if (!grid.inside(n)) continue;
              const std::size_t j = grid.index(n);
              const auto d = static_cast<std::uint8_t>(dx * dx + dy * dy + dz * dz);
              if (solid[j] != kind && d < squared[j]) squared[j] = d;
            }
      }
  return squared;
}

}  // namespace

Vec3 closest_on_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) noexcept {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const Vec3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double sum = va + vb + vc;
  if (!(sum > 0)) return a;  // a triangle without area: its edges were tried above
  return a + ab * (vb / sum) + ac * (vc / sum);
}

void check_lattice(IVec3 size, double leaf_mm, const Where& where, std::uint64_t most) {
  if (!(leaf_mm > 0 && std::isfinite(leaf_mm)))
    throw Error(where, msg("the leaf must be larger than 0 mm"),
                msg("give --leaf-mm 0.05, for example"));
  if (size.x < 1 || size.y < 1 || size.z < 1)
    throw Error(where, msg("nothing to build"), msg("check the size of the input"));
  const int widest = std::max({size.x, size.y, size.z});
  if (widest > Octree::k_max_edge_leaves)
    throw Error(FileError::too_large, where,
                msg("{} leaves along one edge, 1024 is the most", widest),
                msg("use a larger --leaf-mm, or check that the unit is mm"));
  const std::uint64_t leaves = cells_of(size);
  if (leaves > most)
    throw Error(FileError::too_large, where, msg("{} leaves, {} is the most", leaves, most),
                msg("use a larger --leaf-mm, or check that the unit is mm"));
}

void check_triangle_work(const TissueGrid& lattice, const TriangleMesh& mesh,
                         const std::string& where) {
  std::uint64_t near = 0;
  for (const auto& t : mesh.triangles) {
    Bounds box;
    for (const auto corner : t) box.add(mesh.vertices_mm[corner]);
    const auto leaves = [&](double mm) {
      return static_cast<std::uint64_t>(std::min(mm / lattice.leaf_mm, 1024.0)) + 5;
    };  // and the band
    near += leaves(box.high.x - box.low.x) * leaves(box.high.y - box.low.y) *
            leaves(box.high.z - box.low.z);
    if (near > k_max_near_triangles)
      throw Error(
          FileError::too_large, Name{where},
          msg("its triangles have more than {} leaves near them, the most", k_max_near_triangles),
          msg("use a larger --leaf-mm, or a mesh of fewer large triangles"));
  }
}

BandDistance::BandDistance(const TissueGrid& grid, float band_leaves)
    : size_(grid.size),
      leaf_mm_(grid.leaf_mm),
      band_(band_leaves),
      first_mm_(grid.centre_mm({0, 0, 0})),
      leaves_(grid.count(), k_no_surface) {}

void BandDistance::add(const TriangleMesh& mesh, const AcceptSurface& accept) {
  const auto low_leaf = [](double v, int n) {
    return std::clamp(static_cast<int>(std::ceil(std::clamp(v, -1e6, 1e6))), 0, n);
  };
  const auto high_leaf = [](double v, int n) {
    return std::clamp(static_cast<int>(std::floor(std::clamp(v, -1e6, 1e6))), -1, n - 1);
  };
  for (const auto& t : mesh.triangles) {
    const Vec3 a = (mesh.vertices_mm[t[0]] - first_mm_) / leaf_mm_;
    const Vec3 b = (mesh.vertices_mm[t[1]] - first_mm_) / leaf_mm_;
    const Vec3 c = (mesh.vertices_mm[t[2]] - first_mm_) / leaf_mm_;
    const Vec3 across = cross(b - a, c - a);
    const double area = length(across);
    if (!(area > 1e-12)) continue;
    const Vec3 normal = across / area;
    const double plane = dot(normal, a);
    const int x0 = low_leaf(std::min({a.x, b.x, c.x}) - band_, size_.x),
              x1 = high_leaf(std::max({a.x, b.x, c.x}) + band_, size_.x);
    const int y0 = low_leaf(std::min({a.y, b.y, c.y}) - band_, size_.y),
              y1 = high_leaf(std::max({a.y, b.y, c.y}) + band_, size_.y);
    const int z0 = low_leaf(std::min({a.z, b.z, c.z}) - band_, size_.z),
              z1 = high_leaf(std::max({a.z, b.z, c.z}) + band_, size_.z);
    for (int z = z0; z <= z1; ++z)
      for (int y = y0; y <= y1; ++y) {
        float* row =
            leaves_.data() + (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y) +
                              static_cast<std::size_t>(y)) *
                                 static_cast<std::size_t>(size_.x);
        for (int x = x0; x <= x1; ++x) {
          const Vec3 p{double(x), double(y), double(z)};
          const double best = std::min(row[x], band_);
          if (std::fabs(dot(normal, p) - plane) >= best) continue;  // its plane is already farther
          const Vec3 q = closest_on_triangle(p, a, b, c);
          const double d = length(p - q);
          if (d >= best || (accept && !accept(first_mm_ + q * leaf_mm_, normal))) continue;
          row[x] = static_cast<float>(d);
        }
      }
  }
}

void BandDistance::encode(TissueGrid& grid, const std::vector<Tissue>& tissues) const {
  bool is_solid[256] = {};
  for (const auto& t : tissues) is_solid[t.id] = t.solid;
  std::vector<std::uint8_t> solid(grid.count());
  for (std::size_t i = 0; i < solid.size(); ++i) solid[i] = is_solid[grid.tissue[i]];
  const auto squared = squared_to_other_kind(grid, solid);
  for (std::size_t i = 0; i < solid.size(); ++i) {
    double d = k_distance_band_leaves;
    if (squared[i] != 255) {
      // The surface parts this centre from the nearest of the other kind, so it is no farther. And
      // a ball of one leaf's diagonal just behind the surface holds a centre of the other kind, so
      // it is at most that diagonal nearer.
      const double other = std::sqrt(static_cast<double>(squared[i]));
      const double known = leaves_[i];
      d = known >= k_no_surface ? std::max(other - 0.5, 0.0)
                                : std::clamp(known, std::max(other - 1.75, 0.0), other);
    }
    grid.distance[i] = encode_distance(solid[i] ? -d : d);
  }
  grid.make_consistent(tissues);
}

void set_surface_from_field(TissueGrid& grid, const std::vector<Tissue>& tissues,
                            std::span<const float> field,
                            const std::function<double(Vec3)>& exact) {
  std::vector<std::uint8_t> inside(field.size());
  for (std::size_t i = 0; i < field.size(); ++i) inside[i] = field[i] < 0;
  const Vec3 first = grid.centre_mm({0, 0, 0});
  const auto fraction = [&](IVec3 a, IVec3 b) {
    double fa = field[grid.index(a)], fb = field[grid.index(b)];
    double ta = 0.0, tb = 1.0, t = fa / (fa - fb);
    if (exact) {
      const Vec3 from = grid.centre_mm(a), step = grid.centre_mm(b) - from;
      for (int i = 0; i < 3;
           ++i) {  // false position, its old end halved so that it cannot stall (Illinois)
        t = std::clamp(ta + (tb - ta) * fa / (fa - fb), 0.0, 1.0);
        const double f = exact(from + step * t);
        if (f < 0) {
          ta = t;
          fa = f;
          fb *= 0.5;
        } else {
          tb = t;
          fb = f;
          fa *= 0.5;
        }
        if (std::fabs(f) < 1e-7 || !(fa < fb)) break;
      }
    }
    return std::clamp(t, 1e-3, 1 - 1e-3);
  };
  BandDistance band(grid);
  band.add(march_tetrahedra(grid.size, first, grid.leaf_mm, inside, fraction));
  band.encode(grid, tissues);
}

}  // namespace cavum
