// An upper second premolar of our own, made from formulae: two cusps with a fissure between them,
// one root, a pulp chamber that is wide from buccal to lingual and narrow from mesial to distal,
// with two horns, and one oval canal. Measures: means of the permanent upper second premolar as
// dental anatomy teaches them (crown 8.5 mm high, 7 mm mesiodistally, 9 mm buccolingually; at the
// neck 5 and 8 mm; root 14 mm).
#pragma once

#include "engine/base/vec.h"
#include "engine/tooth/tooth.h"

namespace cavum {

struct PremolarShape {
  double leaf_mm = 0.05;            ///< 0.03 to 0.5
  double periodontium_mm = 1.0;     ///< 0 = none
  double occlusal_enamel_mm = 1.6;  ///< under the central fissure, along z; 1.2-2.2
  double lateral_enamel_mm = 1.15;  ///< of the walls at the height of contour; 0.9-1.6
  double chamber_roof_mm = -2.0;    ///< z of the roof between the horns; -3.0 to -1.2
};

/// The shape, as `FormulaTooth` asks.
class Premolar {
 public:
  static constexpr double k_steepest = 3.2;
  explicit Premolar(const PremolarShape& shape) : shape_(shape) {}
  [[nodiscard]] double outside(Vec3 p) const noexcept;
  [[nodiscard]] double pulp(Vec3 p) const noexcept;
  [[nodiscard]] double core(Vec3 p) const noexcept;
  [[nodiscard]] static double neck_mm(double x, double y) noexcept;

 private:
  PremolarShape shape_;
};

/// About 6 s at 0.05 mm. Throws Error on a parameter out of its range.
[[nodiscard]] Tooth make_premolar(const PremolarShape& shape);

}  // namespace cavum
