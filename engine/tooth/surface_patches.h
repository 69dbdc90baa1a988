// The tooth's surface for the eye, in many small meshes, so that after a cut only those are made
// again whose leaves changed. Every patch covers 16x16x16 cells between leaf centres; vertices in
// the border of two patches are equal bit for bit, and all patches together are a closed 2-manifold
// whatever the leaves hold. Marching cubes: a third of the triangles of the marching tetrahedra in
// surface_mesh.h.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/tooth/leaf_blocks.h"

namespace cavum {

/// 20 bytes, as a graphics card takes them.
struct PatchVertex {
  std::array<float, 3> position_mm;    ///< tooth frame
  std::array<std::int16_t, 3> normal;  ///< unit, outwards, times 32767
  std::uint8_t tissue;                 ///< of the leaf inside the surface
  std::uint8_t beside;  ///< of the leaf outside it: air, pulp, periodontium; of a tissue's own
                        ///< surface also its neighbour
  friend bool operator==(const PatchVertex&, const PatchVertex&) = default;
};

struct SurfacePatch {
  std::vector<PatchVertex> vertices;
  std::vector<std::array<std::uint16_t, 3>> triangles;  ///< counter-clockwise seen from outside
  friend bool operator==(const SurfacePatch&, const SurfacePatch&) = default;
};

/// One surface of a tooth. Belongs to one thread, that of its LeafBlocks; needs no octree. Several
/// surfaces may share the LeafBlocks:
///     changed.clear(); blocks.take(octree, changed);                     // short; while the
///     octree stands still touched.clear(); solid.update(blocks, changed, touched);           //
///     then the patches `touched` go to the graphics card
class SurfacePatches {
 public:
  static constexpr int k_edge = 16;  ///< of a patch, cells
  /// The hard tissues together, as contact feels them (its vertices sit on the stored distance):
  /// with the walls of the pulp chamber and canals.
  static constexpr std::uint8_t k_hard_tissue = k_air;

  /// The surface of one tissue by its id, or of all hard tissue. A tissue that is not there has no
  /// triangles.
  explicit SurfacePatches(const LeafBlocks& leaves, std::uint8_t tissue = k_hard_tissue);
  ~SurfacePatches();
  SurfacePatches(SurfacePatches&&) noexcept;
  SurfacePatches& operator=(SurfacePatches&&) noexcept;

  /// Makes anew what the changed boxes reach. Appends the patches that differ now to `touched`,
  /// each once, in rising order.
  void update(const LeafBlocks& leaves, std::span<const LeafBounds> changed,
              std::vector<std::uint32_t>& touched);

  /// Patches are numbered from 0; most are empty. References hold until the next update.
  [[nodiscard]] std::size_t count() const noexcept { return patches_.size(); }
  /// Patches along x, y, z; x counts fastest. Patch (i, j, k) begins at the middle of leaf 16 (i,
  /// j, k) - 1.
  [[nodiscard]] IVec3 size() const noexcept { return size_; }
  [[nodiscard]] const SurfacePatch& patch(std::size_t number) const { return patches_.at(number); }
  [[nodiscard]] std::size_t triangle_count() const noexcept;

 private:
  struct Maker;  // room to work in
  IVec3 size_;   // patches
  std::unique_ptr<Maker> maker_;
  std::vector<SurfacePatch> patches_;
  std::vector<std::uint8_t> reached_;  // by patch, while updating
};

}  // namespace cavum
