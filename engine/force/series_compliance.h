// Something elastic between handpiece and tooth (a holder, a clamp, a ligament): a spring ks in series with
// the tissue's k, so that k·X becomes k·X/(1 + k/ks). Or one that gives way the more the harder it is pressed: k·X/(1 + k·X/Fs).
// The damper stays as it is, on the whole motion.
#pragma once

#include "engine/force/term_kinds.h"

namespace cavum {

class SeriesCompliance final : public ForceTerm {
 public:
  /// ks > 0, N/mm; Fs > 0, N, the force at which half of k·X is lost. Infinite: not there.
  SeriesCompliance(double ks_n_per_mm, double softening_force_n) : ks_n_per_mm_(ks_n_per_mm), softening_force_n_(softening_force_n) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double ks_n_per_mm_, softening_force_n_;
};

extern const TermKind k_series_compliance;

}  // namespace cavum
