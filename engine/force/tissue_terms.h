// What tissue does beyond k·X + c·V. Each is part of the tissue's force: none in air, and the sum never pulls.
// Formulae: PHYSICS.md section 4; `cavum explain` finds them in measured data and writes them into a force model.
#pragma once

#include "engine/force/term_kinds.h"

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

/// One or two Maxwell branches beside the Voigt law: Σ k_i ∫ e^(−(t−s)/τ_i) V ds since contact began. k_i in N/mm, τ_i in s.
class Relaxation final : public ForceTerm {
 public:
  Relaxation(double k1_n_per_mm, double tau1_s, double k2_n_per_mm, double tau2_s) : k_n_per_mm_{k1_n_per_mm, k2_n_per_mm}, tau_s_{tau1_s, tau2_s} {}
  /// memory[0], [1]: stretch of the branches, mm; memory[2]: X of the tick before, mm.
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double k_n_per_mm_[2], tau_s_[2];
};

/// A constant force of the cutting edges while in contact and spinning, N.
class EdgeForce final : public ForceTerm {
 public:
  explicit EdgeForce(double edge_n) : edge_n_(edge_n) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double edge_n_;
};

extern const TermKind k_hidden_layer;
extern const TermKind k_graded_stiffness;
extern const TermKind k_nonlinear_stiffness;
extern const TermKind k_feed_power_law;
extern const TermKind k_relaxation;
extern const TermKind k_edge_force;

}  // namespace cavum
