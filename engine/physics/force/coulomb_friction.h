// Dry friction of joints and guides: Fc·tanh(V/v0) against the motion, the same in air; it flips where the
// motion does. Source: HAP-DENT paper, the friction it blames for the intercept of eq. 6.
#pragma once

#include "engine/physics/force/term_kinds.h"

namespace cavum {

class CoulombFriction final : public ForceTerm {
 public:
  /// Fc, N, >= 0; v0 > 0, mm/s: at v0 the friction has 76 % of Fc.
  CoulombFriction(double fc_n, double v0_mm_s) : fc_n_(fc_n), v0_mm_s_(v0_mm_s) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double fc_n_, v0_mm_s_;
};

extern const TermKind k_coulomb_friction;

}  // namespace cavum
