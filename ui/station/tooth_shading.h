// What the eye needs to know of a place of the tooth's surface beyond where it is: the tissues it
// is of, blended over two leaves so that borders run smoothly; how much of the light around reaches
// it (cones through the leaves, in blocks of four and larger), and whether dentin shines through
// from below. Worked out from the leaves once and again where they change, so it costs nothing
// while drawing and is the same from every side.
#pragma once

#include <span>
#include <vector>

#include "engine/tooth/surface_patches.h"
#include "ui/station/gpu.h"

namespace cavum::station {

class ToothShading {
 public:
  explicit ToothShading(const LeafBlocks& leaves);
  /// After leaves changed.
  void update(const LeafBlocks& leaves, std::span<const LeafBounds> changed);

  /// The patch `number` (along x, y, z) for the graphics card. `own`: a tissue's own surface is all
  /// of that tissue; `k_air` = looked up.
  [[nodiscard]] std::vector<ToothVertex> shaded(const LeafBlocks& leaves, const SurfacePatch& patch,
                                                IVec3 number, std::uint8_t own) const;
  /// As far as a change of leaves changes the light, mm.
  static constexpr double k_reach_mm = 2.4;

  /// Share of the light around that reaches a place of the surface, 0..1.
  [[nodiscard]] float open(const glm::vec3& at_mm, const glm::vec3& normal) const;

 private:
  /// Shares of cubes that hold something, 0..255; each level has cubes twice as large.
  struct Shares {
    IVec3 size;
    std::vector<std::uint8_t> share;
    [[nodiscard]] int at(int x, int y, int z) const {
      if (x < 0 || y < 0 || z < 0 || x >= size.x || y >= size.y || z >= size.z) return 0;
      return share[static_cast<std::size_t>((z * size.y + y) * size.x + x)];
    }
  };
  static constexpr std::size_t k_levels = 4;
  using Pyramid = std::array<Shares, k_levels>;
  void count(const LeafBlocks& leaves, IVec3 low, IVec3 high);
  static void halve(Pyramid& pyramid, IVec3 low, IVec3 high);
  [[nodiscard]] float look_up(const Pyramid& pyramid, const glm::vec3& at_mm, float wide_mm) const;

  glm::vec3 origin_mm_;
  float cell_mm_;
  double leaf_mm_;
  Pyramid filled_, dentin_;
};

}  // namespace cavum::station
