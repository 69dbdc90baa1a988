#include "engine/force/series_compliance.h"

#include <limits>

#include "engine/force/term_laws.h"

namespace cavum {

TermForce SeriesCompliance::evaluate(const TermInput& in, TermMemory&) const noexcept {
  const double k = in.stiffness_n_per_mm;
  // k·X/(1 + k/ks) − k·X, and k·X/(1 + k·X/Fs) − k·X; a spring that is not given adds −0, which changes no bit
  return {-k * in.penetration_mm * (k / (k + ks_n_per_mm_)) + k * softened_mm(in.penetration_mm, k, softening_force_n_), 0.0};
}

constexpr double k_rigid = std::numeric_limits<double>::infinity();
const TermKind k_series_compliance{"series_compliance",
                                   {{"ks_n_per_mm", 1e-3, 1e6, k_rigid}, {"softening_force_n", 1e-3, 1e6, k_rigid}},
                                   [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<SeriesCompliance>(p[0], p[1]); }};

}  // namespace cavum
