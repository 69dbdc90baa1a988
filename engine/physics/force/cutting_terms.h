// What cutting adds to the tissue's force: a bur that wears, water, warmth, and a vibration at a rate of its own.
// Sources: docs/physics.md section 6. All are parts of the tissue's force: none in air, and the sum never pulls.
#pragma once

#include "engine/physics/force/term_kinds.h"

namespace cavum {

/// A worn bur needs more force: F w W, W the volume that it has removed since it was new.
class Wear final : public ForceTerm {
 public:
  /// w in 1/mm³, either sign. `carried`: W goes on over the sessions of a recording that counts anew in each; an exam is one session.
  Wear(double per_mm3, bool carried) : per_mm3_(per_mm3), carried_(carried) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;
  [[nodiscard]] bool counts_removed() const noexcept override { return true; }

 private:
  double per_mm3_;
  bool carried_;
};

/// A sin(2π (f t + phase)) in contact, or only while the tool turns in it; t since the exam or the recording began.
class Chatter final : public ForceTerm {
 public:
  /// A in N, f in Hz, phase in turns. A device of 1 kHz feels f at its alias.
  Chatter(double amplitude_n, double frequency_hz, double phase_turns, bool spinning = false)
      : amplitude_n_(amplitude_n), frequency_hz_(frequency_hz), phase_turns_(phase_turns), spinning_(spinning) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double amplitude_n_, frequency_hz_, phase_turns_;
  bool spinning_;
};

/// Water changes the force by a fraction of it: F w wet.
class Coolant final : public ForceTerm {
 public:
  /// -1 … 10; below 0 water eases the cut.
  explicit Coolant(double fraction) : fraction_(fraction) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double fraction_;
};

/// Warm tissue is softer: −F h ΔT. Where no temperature was measured, tissue warms in proportion to the force while the tool turns in it, and
/// cools: ΔT' = g F − ΔT/τ, exact for a force that is constant within the tick. It cools in air too, and one ΔT stands for the whole tooth.
class ThermalSoftening final : public ForceTerm {
 public:
  /// h in 1/K; g >= 0 in K/(N·s) and τ > 0 in s, both without a source: assumed until they are measured.
  ThermalSoftening(double per_k, double heating_k_per_n_s, double cooling_s)
      : per_k_(per_k), heating_k_per_n_s_(heating_k_per_n_s), cooling_s_(cooling_s) {}
  /// memory[0]: ΔT, K, when it is not measured.
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double per_k_, heating_k_per_n_s_, cooling_s_;
};

extern const TermKind k_wear;
extern const TermKind k_chatter;
extern const TermKind k_coolant;
extern const TermKind k_thermal_softening;

}  // namespace cavum
