// A lower first molar of our own, made from formulae: five cusps, fissures, enamel that thins to
// nothing at the neck, dentin, a pulp chamber with a horn under each cusp and a flat floor, two to
// four canals, two roots. Nothing is measured from a person, so it can be shipped, altered and
// published freely. Only + - * / and sqrt are used: the same parameters give the same bytes
// everywhere.
#pragma once

#include "engine/base/vec.h"
#include "engine/tooth/tooth.h"

namespace cavum {

/// What can be chosen about the molar. Defaults follow textbook means of the permanent lower first
/// molar: crown 11 x 10 mm and about 7 mm high, root 13 mm, trunk of the roots 3-4 mm, chamber roof
/// at the neck's level.
struct MolarShape {
  double leaf_mm = 0.05;  ///< 0.03 to 0.5; 0.05 is the exam tooth
  int canals = 3;  ///< 2 (one per root), 3 (two mesial: the most common), 4 (two in each root)
  double periodontium_mm = 1.0;      ///< 0 = none; see periodontium.h
  double occlusal_enamel_mm = 1.75;  ///< depth of enamel under the central fossa, along z, before
                                     ///< the fissure is cut; 1.2-2.2
  double lateral_enamel_mm =
      1.25;  ///< thickness of the walls' enamel at the height of contour; 1.0-2.0
  double chamber_roof_mm = -2.5;   ///< z of the roof, below the fossa's 1.3: 3.8 mm of enamel and
                                   ///< dentin to drill; -3.2 to -1.8
  double chamber_height_mm = 1.8;  ///< roof to floor; 1.5-2 mm in a grown-up tooth; 1.0-2.2
};

/// The shape as functions of a point in the tooth frame (mm): each is negative inside its body and
/// about a distance near its surface.
class Molar {
 public:
  static constexpr double k_steepest = 3.2;  ///< measured 3.13, in the roots
  explicit Molar(const MolarShape& shape) : shape_(shape) {}
  /// The whole tooth without regard to what it is made of.
  [[nodiscard]] double outside(Vec3 p) const noexcept;
  /// Pulp chamber, horns and canals.
  [[nodiscard]] double pulp(Vec3 p) const noexcept;
  /// Dentin core of the crown: the border between enamel and dentin is its zero.
  [[nodiscard]] double core(Vec3 p) const noexcept;
  /// z of the neck (the cervical line) around (x, y): higher on the mesial and distal side.
  [[nodiscard]] static double neck_mm(double x, double y) noexcept;

 private:
  [[nodiscard]] double crown(Vec3 p) const noexcept;
  [[nodiscard]] double roots(Vec3 p) const noexcept;
  MolarShape shape_;
};

/// Builds the molar. Distances are true distances to a triangulation whose corners lie on the
/// formulae's zero (a few micrometres at a 0.05 mm leaf). About 9 s at 0.05 mm. Throws Error on a
/// parameter out of its range.
[[nodiscard]] Tooth make_molar(const MolarShape& shape);

}  // namespace cavum
