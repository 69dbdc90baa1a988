// A gray volume or label map as it stands in memory, whatever format it came from.
#pragma once

#include <array>
#include <vector>

#include "engine/base/pose.h"

namespace cavum {

/// A volume in the file's physical frame: see place_mm.
struct Volume {
  IVec3 size;                                 ///< voxels
  std::array<double, 3> spacing_mm{1, 1, 1};  ///< > 0
  std::array<Vec3, 3> axis{Vec3{1, 0, 0}, Vec3{0, 1, 0},
                           Vec3{0, 0, 1}};  ///< unit directions of i, j, k
  Vec3 origin_mm;                           ///< centre of voxel (0,0,0)
  std::vector<float> gray;                  ///< x fastest
  bool spacing_assumed = false;             ///< neither the file nor the user gave one

  [[nodiscard]] std::size_t index(IVec3 v) const noexcept { return cell_index(v, size); }
  [[nodiscard]] std::size_t voxels() const noexcept { return cells_of(size); }
  [[nodiscard]] Vec3 place_mm(Vec3 voxel) const noexcept {
    return origin_mm + axis[0] * (spacing_mm[0] * voxel.x) + axis[1] * (spacing_mm[1] * voxel.y) +
           axis[2] * (spacing_mm[2] * voxel.z);
  }
  /// Inverse of place_mm (the axes are orthonormal).
  [[nodiscard]] Vec3 voxel_at(Vec3 mm) const noexcept {
    const Vec3 d = mm - origin_mm;
    return {dot(axis[0], d) / spacing_mm[0], dot(axis[1], d) / spacing_mm[1],
            dot(axis[2], d) / spacing_mm[2]};
  }
};

}  // namespace cavum
