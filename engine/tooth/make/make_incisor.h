// An upper central incisor of our own, made from formulae: a blade-like crown with a cingulum and a
// hollow lingual face, one round root, a pulp chamber that is flat and wide near the incisal edge,
// with two horns, and runs into one canal. Measures: means of the permanent upper central incisor
// as dental anatomy teaches them (crown 10.5 mm high, 8.5 mm mesiodistally, 7 mm labiolingually; at
// the neck 7 and 6 mm; root 13 mm; the cervical line rises 3.5 mm towards mesial, 2.5 mm towards
// distal).
#pragma once

#include "engine/base/vec.h"
#include "engine/tooth/tooth.h"

namespace cavum {

struct IncisorShape {
  double leaf_mm = 0.05;           ///< 0.03 to 0.5
  double periodontium_mm = 1.0;    ///< 0 = none
  double incisal_enamel_mm = 1.5;  ///< at the edge, along z; 1.0-2.0
  double lateral_enamel_mm = 0.8;  ///< of the faces at mid-crown; 0.5-1.0
  double chamber_top_mm = 1.2;  ///< z of the chamber's incisal end between the horns, the edge lies
                                ///< at 5.25; -1.0 to 2.0
};

/// The shape, as `FormulaTooth` asks.
class Incisor {
 public:
  static constexpr double k_steepest =
      8.0;  ///< the thin ridge of the core, seen from outside; 5.3 was found
  explicit Incisor(const IncisorShape& shape) : shape_(shape) {}
  [[nodiscard]] double outside(Vec3 p) const noexcept;
  [[nodiscard]] double pulp(Vec3 p) const noexcept;
  [[nodiscard]] double core(Vec3 p) const noexcept;
  [[nodiscard]] static double neck_mm(double x, double y) noexcept;

 private:
  IncisorShape shape_;
};

/// About 6 s at 0.05 mm. Throws Error on a parameter out of its range.
[[nodiscard]] Tooth make_incisor(const IncisorShape& shape);

}  // namespace cavum
