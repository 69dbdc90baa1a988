// Distances on the leaf lattice: exact distance to triangles in a narrow band, and the surface of a
// smooth field as distance codes. Shared by the makers and importers, so that every tooth carries
// the same kind of surface: exact on planes, a few micrometres on curves.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/where.h"
#include "engine/tooth/surface_mesh.h"
#include "engine/tooth/tissue_grid.h"

namespace cavum {

/// Leaves of a lattice that a tooth is made or imported on, air and all: a molar of 24 mm at 0.05
/// mm has 20 million.
inline constexpr std::uint64_t k_max_lattice_leaves = 48'000'000;
/// The same of a tooth with what was set beside it: no fields are laid over these leaves, so each
/// takes two bytes and not twenty.
inline constexpr std::uint64_t k_max_row_leaves = 96'000'000;
/// Leaves near the single triangles of a mesh, all together: each is asked for its distance. A
/// tooth's layer scanned at 0.1 mm has 30 million.
inline constexpr std::uint64_t k_max_near_triangles = 400'000'000;
/// Throws Error(`where`, ...) unless the lattice has 1..1024 leaves along every axis, a leaf > 0,
/// and no more leaves than `most`.
void check_lattice(IVec3 size, double leaf_mm, const Where& where,
                   std::uint64_t most = k_max_lattice_leaves);

/// Throws Error(`where`, ...) when a mesh has more leaves near its triangles than above: many that
/// are large and close together.
void check_triangle_work(const TissueGrid& lattice, const TriangleMesh& mesh,
                         const std::string& where);

/// The point of a triangle that is nearest to `p`: by the Voronoi regions of its corners, edges and
/// face.
[[nodiscard]] Vec3 closest_on_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) noexcept;

/// Says whether a surface point counts: `point_mm` on a triangle, `normal` its unit outward normal.
using AcceptSurface = std::function<bool(Vec3 point_mm, Vec3 normal)>;

/// Unsigned distances, in leaves, from leaf centres to a surface; leaves farther than the band keep
/// `k_no_surface`.
class BandDistance {
 public:
  static constexpr float k_no_surface = 1e9f;
  /// What the distance codes hold, and a little.
  static constexpr float k_code_band_leaves = static_cast<float>(k_distance_band_leaves) + 0.25f;
  /// Of `grid` only the lattice counts.
  explicit BandDistance(const TissueGrid& grid, float band_leaves = k_code_band_leaves);
  /// Takes the nearer of what is known and this mesh (exact point-to-triangle distance). Points
  /// that `accept` refuses do not count; an empty `accept` accepts all.
  void add(const TriangleMesh& mesh, const AcceptSurface& accept = {});
  /// Writes the codes of `grid`: sign from the labels, size from the distances, held within what
  /// the labels allow (the surface passes between a leaf and its nearest leaf of the other kind).
  void encode(TissueGrid& grid, const std::vector<Tissue>& tissues) const;
  /// By TissueGrid::index.
  [[nodiscard]] const std::vector<float>& leaves() const noexcept { return leaves_; }

 private:
  IVec3 size_;
  double leaf_mm_;
  float band_;
  Vec3 first_mm_;  // centre of leaf (0,0,0)
  std::vector<float> leaves_;
};

/// Sets the codes of `grid` from a smooth field at the leaf centres, negative exactly in the solid
/// leaves, any unit. `exact`, when given, is the same field anywhere (mm) and places the surface's
/// vertices more finely.
void set_surface_from_field(TissueGrid& grid, const std::vector<Tissue>& tissues,
                            std::span<const float> field,
                            const std::function<double(Vec3)>& exact = {});

}  // namespace cavum
