// Forces that depend on the way that was gone and not on its speed: a loop between loading and unloading, and play
// between the drive and the tip. Sources: docs/physics.md section 6; Bouc 1967, Wen 1976, Dahl 1968.
#pragma once

#include "engine/physics/force/term_kinds.h"

namespace cavum {

/// α z with Bouc-Wen's z' = V − ((1 − γ) |V| z + γ V |z|)/d in contact, V the rate of X; forgotten in air. The force
/// reaches α d after a way of a few d, and as much less after a reversal.
class Hysteresis final : public ForceTerm {
 public:
  /// α in N/mm, >= 0; d > 0, mm; 0 <= γ <= 1/2: 0 is Dahl's model, 1/2 unloads in a straight line.
  Hysteresis(double alpha_n_per_mm, double d_mm, double gamma) : alpha_n_per_mm_(alpha_n_per_mm), d_mm_(d_mm), gamma_(gamma) {}
  /// memory[0]: z, mm; memory[1]: X of the tick before, mm.
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double alpha_n_per_mm_, d_mm_, gamma_;
};

/// Play between the drive, whose position is known, and the tip: k (tip − X), where the tip follows X once it is b behind or `ahead` before it. In
/// air the play is taken up anew, so that each contact begins with the tip b behind.
class Backlash final : public ForceTerm {
 public:
  /// b >= 0 and `ahead_mm` >= 0 in mm; a negative `ahead_mm` means b. `seen`: contact is where the drive is seen to touch, so that the tip
  /// may still be above the surface and its spring take from c V; else a tip above the surface adds nothing.
  Backlash(double b_mm, double ahead_mm, bool seen = false) : behind_mm_(b_mm), ahead_mm_(ahead_mm < 0.0 ? b_mm : ahead_mm), seen_(seen) {}
  /// memory[0]: place of the tip, mm.
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double behind_mm_, ahead_mm_;
  bool seen_;
};

extern const TermKind k_hysteresis;
extern const TermKind k_backlash;

}  // namespace cavum
