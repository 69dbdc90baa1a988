// A tooth with a seed as a shape: crown with fissures, curved cervical line, roots, enamel that
// follows the crown, pulp with horns and canals. Built from a plan (tooth_plan.h) by formulae with
// + - * / and sqrt, so that the same plan gives the same bytes everywhere.
#pragma once

#include "engine/tooth/make/formula_tooth.h"
#include "engine/tooth/make/occlusal_relief.h"
#include "engine/tooth/make/tooth_plan.h"

namespace cavum {

/// As `FormulaTooth` asks: each function is negative inside its body and about a distance near its
/// surface. Points in the tooth frame, mm.
class GrownTooth {
 public:
  static constexpr bool k_join = true;  // leaves cut off by the lattice (a sliver of enamel at the
                                        // neck) go to the tissue around them
  explicit GrownTooth(ToothPlan plan);
  [[nodiscard]] double outside(Vec3 p) const noexcept;
  [[nodiscard]] double pulp(Vec3 p) const noexcept;
  [[nodiscard]] double core(Vec3 p) const noexcept;
  /// z of the cervical line around (x, y).
  [[nodiscard]] double neck_mm(double x, double y) const noexcept;
  /// A box that holds all of it.
  [[nodiscard]] FormulaBox box() const;
  /// See FormulaTooth.
  [[nodiscard]] double steepest() const noexcept { return plan_.steepest; }
  [[nodiscard]] const ToothPlan& plan() const noexcept { return plan_; }

 private:
  struct Sides {
    double mesial = 0.0, distal = 0.0, buccal = 0.0, lingual = 0.0;
  };
  /// About the distance to the walls without grooves, each wall moved inwards by `less`.
  [[nodiscard]] double wall(Vec3 p, const Sides& less) const noexcept;
  /// Thickness of the walls' enamel at the height of a place.
  [[nodiscard]] Sides enamel(Vec3 p) const noexcept;
  /// Crown and trunk; `with_enamel` false: the dentin below the enamel.
  [[nodiscard]] double trunk(Vec3 p, bool with_enamel) const noexcept;
  /// Trunk and roots.
  [[nodiscard]] double body(Vec3 p, bool with_enamel) const noexcept;
  [[nodiscard]] double neck(double x, double y) const noexcept;  // in the plan's frame
  [[nodiscard]] double canal(Vec3 p, const CanalPlan& c) const noexcept;

  ToothPlan plan_;
  OcclusalRelief relief_;
  double highest_tip_ = 0.0, lowest_tip_ = 1e9;  // of the cusps, in the plan's frame
};

/// The tooth of a plan. Throws Error on a leaf outside 0.03..0.5 mm or a periodontium outside 0..5
/// mm.
[[nodiscard]] Tooth grow_tooth(const GrownTooth& shape, double leaf_mm, double periodontium_mm,
                               const std::string& name, const FormulaKind& what);

}  // namespace cavum
