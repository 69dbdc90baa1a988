// A bur that turns off its axis presses once in every turn: a line at the spindle rate, seen at
// its alias by whatever samples it (200,000 rpm at 1 kHz: 333 Hz). Only in contact and turning.
#pragma once

#include "engine/physics/force/term_kinds.h"

namespace cavum {

/// F = (A + e·k)·sin(2π·turns), turns = phase + ∫ rpm/60 dt; by the clock, phase + rpm/60·t, as of a spindle that keeps its rate. The true rate may
/// be a little off the one that is written down: `rate_ratio` times it.
class RunOut final : public ForceTerm {
 public:
  /// Amplitude A, N; eccentricity e, µm (3.5 to 50 are usual), felt through the tissue's k; phase in turns, 0..1.
  RunOut(double amplitude_n, double eccentricity_um, double phase_turns, bool by_clock = false, double rate_ratio = 1.0)
      : amplitude_n_(amplitude_n),
        eccentricity_mm_(eccentricity_um * 1e-3),
        phase_turns_(phase_turns),
        rate_ratio_(rate_ratio),
        by_clock_(by_clock) {}
  /// memory[0]: turns since the start, less the whole ones.
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double amplitude_n_, eccentricity_mm_, phase_turns_, rate_ratio_;
  bool by_clock_;
};

extern const TermKind k_run_out;

}  // namespace cavum
