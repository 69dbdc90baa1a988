// Measures a tooth the way a morphologist would: on the finished octree alone, without knowing how
// it was made. Lengths in mm, angles in degrees, in the tooth frame (+x mesial, +y buccal, +z
// occlusal).
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "engine/tooth/tooth.h"

namespace cavum::testing_tooth {

/// Measures by name, in the order of docs/teeth.md.
using Measures = std::vector<std::pair<std::string, double>>;

/// A pulp canal in one horizontal slice.
struct CanalSlice {
  double x_mm, y_mm, mesiodistal_mm, buccolingual_mm;
};

class ToothMeter {
 public:
  explicit ToothMeter(const Tooth& tooth);

  /// Height of the occlusal surface over (x, y), between leaves, from the octree's distances; -1e9
  /// beside the tooth.
  [[nodiscard]] double surface_z(double x, double y) const;
  /// The highest place of the surface in a box.
  [[nodiscard]] Vec3 highest(double low_x, double high_x, double low_y, double high_y) const;
  /// Lowest enamel within 0.5 mm of the plane through the axis, on one side: x or y is `towards`,
  /// its sign the side.
  [[nodiscard]] double cervical_z(char towards, double sign) const;
  /// Outermost hard tissue on one side, |other coordinate - at| < `within`, at heights from..to:
  /// its coordinate (positive) and its height.
  [[nodiscard]] std::pair<double, double> outermost(char towards, double sign, double from_z,
                                                    double to_z, double at = 0.0,
                                                    double within = 99.0) const;
  /// Thickness of enamel from a surface point: distance to the nearest dentin.
  [[nodiscard]] double enamel_mm(Vec3 surface) const;
  /// Thickness of enamel of a wall: from the outermost hard leaf at a height along the middle
  /// plane.
  [[nodiscard]] double wall_enamel_mm(char towards, double sign, double z, double at) const;
  /// Shortest way from a point to pulp.
  [[nodiscard]] double to_pulp_mm(Vec3 from) const;
  /// Shortest way from the pulp's highest place within 1.5 mm of (x, y) to enamel.
  [[nodiscard]] double horn_to_enamel_mm(double x, double y) const;
  /// Tissues straight down from above at (x, y): first z of each, from the top.
  [[nodiscard]] std::vector<std::pair<std::uint8_t, double>> column(double x, double y) const;
  /// Pulp at a height: bodies larger than a few leaves, by x from distal to mesial.
  [[nodiscard]] std::vector<CanalSlice> canals(double z) const;
  /// Thickness of dentin from the border of a canal to what lies around the root, towards distal
  /// (the furcation's side of a mesial root).
  [[nodiscard]] double to_outside_mm(const CanalSlice& canal, double z) const;
  /// Lowest hard leaf with x from low to high.
  [[nodiscard]] double apex_z(double low_x, double high_x) const;
  /// Across the valley at x: opening angle within 0.25 mm of its bottom, depth below its shoulders
  /// half a millimetre away, y and z of the bottom.
  struct Valley {
    double angle_deg, depth_mm, y_mm, z_mm;
  };
  [[nodiscard]] Valley valley(double x, double low_y, double high_y) const;
  [[nodiscard]] const TissueGrid& grid() const noexcept { return grid_; }

 private:
  [[nodiscard]] bool hard(IVec3 at) const noexcept {
    const auto t = grid_.tissue[grid_.index(at)];
    return t == k_enamel || t == k_dentin;
  }
  [[nodiscard]] double nearest(Vec3 from, std::uint8_t tissue) const;

  const Octree& octree_;
  TissueGrid grid_;
  IVec3 low_, high_;  // of hard tissue
};

[[nodiscard]] Measures measure_molar(const Tooth& tooth);
[[nodiscard]] Measures measure_premolar(const Tooth& tooth);
[[nodiscard]] Measures measure_incisor(const Tooth& tooth);

}  // namespace cavum::testing_tooth
