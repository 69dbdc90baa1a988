// What tissue does beyond k·X + c·V. Each is part of the tissue's force: none in air, and the sum never pulls.
// Formulae: docs/physics.md section 6; `cavum explain` finds them in measured data and writes them into a force model.
#pragma once

#include "engine/physics/force/term_kinds.h"
#include "engine/physics/force/term_laws.h"

namespace cavum {

/// A layer below the surface: Δk·(X − d0) beyond d0. Δk in N/mm, either sign; d0 >= 0 in mm.
class HiddenLayer final : public ForceTerm {
 public:
  HiddenLayer(double dk_n_per_mm, double d0_mm) : dk_n_per_mm_(dk_n_per_mm), d0_mm_(d0_mm) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double dk_n_per_mm_, d0_mm_;
};

/// Stiffness that changes evenly with depth: k·X·(1 − α·X) in place of k·X. α in 1/mm, either sign.
class GradedStiffness final : public ForceTerm {
 public:
  explicit GradedStiffness(double alpha_per_mm) : alpha_per_mm_(alpha_per_mm) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double alpha_per_mm_;
};

/// k·X^m in place of k·X, X in mm (Hertz: m = 1.5). 0.1 <= m <= 5.
class NonlinearStiffness final : public ForceTerm {
 public:
  explicit NonlinearStiffness(double m) : m_(m) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double m_;
};

/// c·|V|^n·sign V in place of c·V, V in mm/s. 0.05 <= n <= 4.
class FeedPowerLaw final : public ForceTerm {
 public:
  explicit FeedPowerLaw(double n) : n_(n) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double n_;
};

/// One or two Maxwell branches beside the Voigt law: Σ k_i ∫ e^(−(t−s)/τ_i) d(X^m) since contact began. k_i in N/mm, τ_i in s; m = 1, or
/// the power of X by which the elastic force of a soft specimen grows (X in mm). `carried`: in air the stretch goes on fading at the same rate, for
/// one site that is pressed again before it is at rest; else each contact begins at rest.
class Relaxation final : public ForceTerm {
 public:
  Relaxation(double k1_n_per_mm, double tau1_s, double k2_n_per_mm, double tau2_s, double exponent = 1.0, bool carried = false)
      : k_n_per_mm_{k1_n_per_mm, k2_n_per_mm}, tau_s_{tau1_s, tau2_s}, exponent_(exponent), carried_(carried) {}
  /// memory[0], [1]: stretch of the branches, mm; memory[2]: X^m of the tick before.
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double k_n_per_mm_[2], tau_s_[2], exponent_;
  bool carried_;
};

/// A constant force of the cutting edges while in contact and spinning, N.
class EdgeForce final : public ForceTerm {
 public:
  explicit EdgeForce(double edge_n) : edge_n_(edge_n) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double edge_n_;
};

/// Tissue with a grain (tubules, prisms): (ε F + A) cos 2(φ − φ0) in contact, F the Voigt force, φ the angle of approach. It is
/// stiffest from φ0 and softest across it.
class Anisotropy final : public ForceTerm {
 public:
  /// ε: part of the force, -1 … 1; A: a force of its own, N; φ0 in degrees.
  Anisotropy(double epsilon, double amplitude_n, double phi0_deg) : epsilon_(epsilon), amplitude_n_(amplitude_n), phi0_(twice_angle(phi0_deg)) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double epsilon_, amplitude_n_;
  SinCos phi0_;
};

extern const TermKind k_hidden_layer;
extern const TermKind k_graded_stiffness;
extern const TermKind k_nonlinear_stiffness;
extern const TermKind k_feed_power_law;
extern const TermKind k_relaxation;
extern const TermKind k_edge_force;
extern const TermKind k_anisotropy;

}  // namespace cavum
