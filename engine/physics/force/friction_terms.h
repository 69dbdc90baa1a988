// Resistance of joints and guides beyond dry friction: in proportion to speed, and friction that falls with speed.
// Both act against the motion, in air too. Sources: docs/physics.md section 6.
#pragma once

#include "engine/physics/force/term_kinds.h"

namespace cavum {

/// b·V.
class ViscousFriction final : public ForceTerm {
 public:
  /// b >= 0, N·s/mm.
  explicit ViscousFriction(double b_n_s_per_mm) : b_(b_n_s_per_mm) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double b_;
};

/// (Fc + (Fs − Fc)·e^(−(V/vs)²))·tanh(V/v0).
class StribeckFriction final : public ForceTerm {
 public:
  /// Fc at speed and Fs from rest, N, >= 0; vs > 0, mm/s, where Fs has fallen by 63 %; v0 > 0, mm/s, as in CoulombFriction.
  StribeckFriction(double fc_n, double fs_n, double vs_mm_s, double v0_mm_s) : fc_n_(fc_n), fs_n_(fs_n), vs_mm_s_(vs_mm_s), v0_mm_s_(v0_mm_s) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double fc_n_, fs_n_, vs_mm_s_, v0_mm_s_;
};

extern const TermKind k_viscous_friction;
extern const TermKind k_stribeck_friction;

}  // namespace cavum
