// Something elastic between handpiece and tooth (a holder, a clamp, a ligament): a spring ks in series with
// the tissue's k, so that k·X becomes k·X/(1 + k/ks). Or one that gives way the more the harder it is pressed: k·X/(1 + k·X/Fs).
// The damper stays as it is, on the whole motion; or the whole Voigt body sits on the spring, F = k·(X − F/ks) + c·(V − F'/ks).
#pragma once

#include "engine/physics/force/term_kinds.h"

namespace cavum {

class SeriesCompliance final : public ForceTerm {
 public:
  /// ks > 0, N/mm; Fs > 0, N, the force at which half of k·X is lost. Infinite: not there. `whole`: the
  /// damper sits on the spring ks too; F starts from 0 at each contact.
  SeriesCompliance(double ks_n_per_mm, double softening_force_n, bool whole)
      : ks_n_per_mm_(ks_n_per_mm), softening_force_n_(softening_force_n), whole_(whole) {}
  /// With `whole`, memory[0]: F, N; memory[1]: (k X + c V)/(1 + k/ks) of the tick before, N; memory[2]: 1 when in contact then.
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double ks_n_per_mm_, softening_force_n_;
  bool whole_;
};

extern const TermKind k_series_compliance;

}  // namespace cavum
