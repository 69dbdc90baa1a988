#include "engine/physics/force/series_compliance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/physics/force/term_laws.h"

namespace cavum {

TermForce SeriesCompliance::evaluate(const TermInput& in, TermMemory& memory) const noexcept {
  const double k = in.stiffness_n_per_mm;
  if (whole_ && std::isfinite(ks_n_per_mm_)) {
    if (!in.touching) {
      memory = {};
      return {};
    }
    // the same as a lag of c/(ks + k) behind a base that is softer by 1 + k/ks
    const double c = in.damping_n_s_per_mm, softer = 1.0 + k / ks_n_per_mm_, tau_s = c / (ks_n_per_mm_ + k);
    const double stiff_n = k * in.penetration_mm + c * in.approach_mm_s, to = stiff_n / softer;
    const double from = memory[2] > 0.0 ? memory[1] : c * in.approach_mm_s / softer;
    const double force_n = in.dt_s <= 0.0 || tau_s <= 0.0 ? to : lagged_n(memory[0], from, to, in.dt_s / tau_s);
    memory = {std::max(0.0, force_n), to, 1.0, 0.0};
    return {memory[0] - stiff_n, 0.0};
  }
  // k·X/(1 + k/ks) − k·X, and k·X/(1 + k·X/Fs) − k·X; a spring that is not given adds −0, which changes no bit
  return {-k * in.penetration_mm * (k / (k + ks_n_per_mm_)) + k * softened_mm(in.penetration_mm, k, softening_force_n_), 0.0};
}

constexpr double k_rigid = std::numeric_limits<double>::infinity();
const TermKind k_series_compliance{
    "series_compliance",
    {{"ks_n_per_mm", 1e-3, 1e6, k_rigid}, {"softening_force_n", 1e-3, 1e6, k_rigid}, {"whole", 0, 1, 0.0}},
    [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<SeriesCompliance>(p[0], p[1], p[2] >= 0.5); }};

}  // namespace cavum
