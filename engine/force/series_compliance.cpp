#include "engine/force/series_compliance.h"

namespace cavum {

TermForce SeriesCompliance::evaluate(const TermInput& in, TermMemory&) const noexcept {
  const double k = in.stiffness_n_per_mm;
  return {-k * in.penetration_mm * (k / (k + ks_n_per_mm_)), 0.0};  // k·X/(1 + k/ks) − k·X
}

const TermKind k_series_compliance{"series_compliance", {{"ks_n_per_mm", 1e-3, 1e6, {}}}, [](const std::vector<double>& p) -> ForceTermPtr {
                                     return std::make_shared<SeriesCompliance>(p[0]);
                                   }};

}  // namespace cavum
