// A tooth as a plain dense grid: what importers and makers produce, and what the octree is built
// from and compared with. Leaf (i,j,k) is the cube whose lower corner is origin + leaf·(i,j,k).
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/vec.h"
#include "engine/tooth/tissues.h"

namespace cavum {

/// One tissue of a tooth. A tissue that is not solid (pulp, periodontium) is void to the contact:
/// the bur enters it without resistance, though its touch still counts with its own k and c.
struct Tissue {
  std::uint8_t id = k_air;
  std::string name;
  bool solid = true;
  friend bool operator==(const Tissue&, const Tissue&) = default;
};

/// The four tissues that every importer knows.
[[nodiscard]] inline std::vector<Tissue> standard_tissues() {
  std::vector<Tissue> four;
  for (const KnownTissue& t : k_tissues)
    if (t.id != k_air && t.id <= k_periodontium) four.push_back({t.id, t.name, t.solid});
  return four;
}

/// Signed distance to the solid surface in one byte: positive outside (air and pulp), ±127 = ±2
/// leaves or more.
inline constexpr double k_distance_band_leaves = 2.0;
inline constexpr int k_distance_far = 127;

/// Code of a distance given in leaves; clamped to the band, ties away from zero.
[[nodiscard]] constexpr std::int8_t encode_distance(double leaves) noexcept {
  const double code = leaves * (k_distance_far / k_distance_band_leaves);
  if (code >= k_distance_far) return k_distance_far;
  if (code <= -k_distance_far) return -k_distance_far;
  return static_cast<std::int8_t>(code >= 0 ? static_cast<int>(code + 0.5)
                                            : static_cast<int>(code - 0.5));
}
[[nodiscard]] constexpr double decode_distance(int code) noexcept {
  return code * (k_distance_band_leaves / k_distance_far);
}

/// Dense labels and distances, x fastest. Invariant: solid leaves have a negative code, all others
/// a positive one (`make_consistent` enforces it).
struct TissueGrid {
  IVec3 size;                         ///< leaves along x, y, z
  double leaf_mm = 0.05;              ///< edge of a leaf, > 0
  Vec3 origin_mm;                     ///< lower corner of leaf (0,0,0), tooth frame
  std::vector<std::uint8_t> tissue;   ///< size.x·size.y·size.z labels
  std::vector<std::int8_t> distance;  ///< codes of the signed distance at the leaf's centre

  void allocate(IVec3 leaves, double leaf, Vec3 origin) {
    size = leaves;
    leaf_mm = leaf;
    origin_mm = origin;
    tissue.assign(count(), k_air);
    distance.assign(count(), k_distance_far);
  }
  [[nodiscard]] std::size_t count() const noexcept { return cells_of(size); }
  [[nodiscard]] std::size_t index(IVec3 i) const noexcept { return cell_index(i, size); }
  [[nodiscard]] bool inside(IVec3 i) const noexcept { return lies_in(i, size); }
  [[nodiscard]] Vec3 centre_mm(IVec3 i) const noexcept {
    return origin_mm + Vec3{i.x + 0.5, i.y + 0.5, i.z + 0.5} * leaf_mm;
  }
  /// Makes every code's sign agree with its label: solid at most -1, void at least +1.
  void make_consistent(const std::vector<Tissue>& tissues) {
    bool solid[256] = {};
    for (const auto& t : tissues) solid[t.id] = t.solid;
    for (std::size_t i = 0; i < tissue.size(); ++i) {
      const int d = distance[i];
      distance[i] = static_cast<std::int8_t>(solid[tissue[i]] ? std::min(d, -1) : std::max(d, 1));
    }
  }
};

}  // namespace cavum
