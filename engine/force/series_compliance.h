// Something elastic between handpiece and tooth (a holder, a clamp, a ligament): a spring ks in series with
// the tissue's k, so that k·X becomes k·X/(1 + k/ks). The damper stays as it is, on the whole motion.
#pragma once

#include "engine/force/term_kinds.h"

namespace cavum {

class SeriesCompliance final : public ForceTerm {
 public:
  /// ks > 0, N/mm.
  explicit SeriesCompliance(double ks_n_per_mm) : ks_n_per_mm_(ks_n_per_mm) {}
  [[nodiscard]] TermForce evaluate(const TermInput& in, TermMemory& memory) const noexcept override;

 private:
  double ks_n_per_mm_;
};

extern const TermKind k_series_compliance;

}  // namespace cavum
