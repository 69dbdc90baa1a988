// The outside of an unprepared tooth, as a scan of it is laid upon: signed distances, and what of
// it is crown.
#pragma once

#include <array>
#include <vector>

#include "engine/lab/scan/surface_index.h"
#include "engine/tooth/tooth.h"

namespace cavum {

class OuterSurface {
 public:
  /// Keeps a reference to `tooth`. Throws Error when nothing of it is solid.
  explicit OuterSurface(const Tooth& tooth);

  struct Distance {
    double mm = 0.0;  ///< signed, positive outside
    Vec3 normal;      ///< unit, out of the tooth
  };
  /// To the outer surface: the octree's own within its band of two leaves, else to the plane of a
  /// place near by (to some hundredths of a millimetre), from a millimetre on the distance of that
  /// place. The wall of the pulp is none of it.
  [[nodiscard]] Distance distance(Vec3 p, Octree::Cursor& cursor) const noexcept;
  /// How far the distances of the octree reach, mm.
  [[nodiscard]] double band_mm() const noexcept {
    return k_distance_band_leaves * tooth_.octree.leaf_mm();
  }
  /// The same at a leaf's centre, mm; -1e9 in the tooth and 1e9 outside it where the outer surface
  /// is further than the band.
  [[nodiscard]] double at_leaf_mm(IVec3 leaf) const noexcept;

  [[nodiscard]] const Tooth& tooth() const noexcept { return tooth_; }
  /// By tissue id: air, and what lies around the tooth.
  [[nodiscard]] const std::array<bool, 256>& outside() const noexcept { return outside_; }
  [[nodiscard]] const SurfaceIndex& index() const noexcept { return index_; }
  [[nodiscard]] const std::vector<SurfacePoint>& points() const noexcept { return points_; }
  /// Those over enamel; all of them where the tooth has none.
  [[nodiscard]] const std::vector<SurfacePoint>& crown() const noexcept { return crown_; }

 private:
  const Tooth& tooth_;
  std::array<bool, 256> outside_{};
  std::vector<SurfacePoint> points_, crown_;
  SurfaceIndex index_;
};

}  // namespace cavum
