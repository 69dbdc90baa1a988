#include "engine/physics/force/force_terms.h"

#include <algorithm>
#include <cmath>

namespace cavum {
namespace {

TermForce sum(const ForceTerms& terms, const TermInput& in, std::span<TermMemory> memory,
              bool& finite) noexcept {
  TermForce total;
  for (std::size_t i = 0; i < terms.size() && i < memory.size(); ++i) {
    const TermForce f = terms[i]->evaluate(in, memory[i]);
    if (std::isfinite(f.tissue_n) && std::isfinite(f.drag_n)) {
      total.tissue_n += f.tissue_n;
      total.drag_n += f.drag_n;
    } else {
      memory[i] = {};
      finite = false;
    }
  }
  return total;
}

double drag_at(const ForceTerms& terms, TermInput in, double speed_mm_s,
               std::array<TermMemory, k_max_terms> memory) noexcept {
  bool finite = true;
  in.speed_mm_s = speed_mm_s;
  return std::max(0.0, sum(terms, in, memory, finite).drag_n);
}

/// Size of the spring's force after the tick: z with z + Ks·dt·u = `pulled_n` and drag(u) = z,
/// found by halving. A fixed number of steps: the same bits everywhere, and the law need not be
/// smooth.
double settled_n(const ForceTerms& terms, const TermInput& in, double pulled_n,
                 double ks_dt_n_s_per_mm, const TermsState& state) noexcept {
  double low = 0.0, high = pulled_n / ks_dt_n_s_per_mm;
  if (drag_at(terms, in, high, state.memory) == 0.0) return 0.0;  // no drag among the terms
  constexpr int k_halvings = 44;
  for (int i = 0; i < k_halvings; ++i) {
    const double u = 0.5 * (low + high);
    (drag_at(terms, in, u, state.memory) + ks_dt_n_s_per_mm * u < pulled_n ? low : high) = u;
  }
  return std::clamp(pulled_n - ks_dt_n_s_per_mm * high, 0.0, pulled_n);
}

}  // namespace

double force_along_feed_n(const ForceTerms& terms, TermInput in,
                          std::span<TermMemory> memory) noexcept {
  const Viscoelastic tissue{in.stiffness_n_per_mm, in.damping_n_s_per_mm};
  const double x = in.touching ? in.penetration_mm : 0.0, v = in.approach_mm_s;
  in.speed_mm_s = v;
  in.penetration_mm = x;
  in.approach_mm_s = in.touching ? v : 0.0;
  in.voigt_n = voigt_force_n(tissue, x, v);
  bool finite = true;
  const TermForce f = sum(terms, in, memory, finite);
  return voigt_force_n(tissue, x, v, f.tissue_n) + f.drag_n;
}

TermsState make_terms_state(const ForceTerms& terms) noexcept {
  TermsState s;
  s.count = terms.size();
  s.counts_removed = std::any_of(terms.begin(), terms.end(),
                                 [](const ForceTermPtr& t) { return t->counts_removed(); });
  return s;
}

TermsForce apply_terms(const ForceTerms& terms, const RenderingModel& rendering, TermInput in,
                       Vec3 moved_mm, TermsState& state) noexcept {
  TermsForce out;
  if (terms.empty()) return out;
  state.velocity_mm_s +=
      (moved_mm / in.dt_s - state.velocity_mm_s) * (in.dt_s / (rendering.speed_filter_s + in.dt_s));
  const double ks = rendering.drag_n_per_mm;
  const Vec3 pulled = state.stretch_n + moved_mm * ks;
  const double size = length(pulled);
  state.stretch_n =
      size > 0.0 ? pulled * (settled_n(terms, in, size, ks * in.dt_s, state) / size) : Vec3{};
  if (!is_finite(state.stretch_n)) state.stretch_n = {};

  in.speed_mm_s = length(state.velocity_mm_s);
  const TermForce f = sum(terms, in, state.memory, out.finite);
  out.tissue_n = in.touching ? f.tissue_n : 0.0;
  if (in.speed_mm_s > 0.0) out.drag_n = state.velocity_mm_s * (-f.drag_n / in.speed_mm_s);
  out.rendered_drag_n = -state.stretch_n;
  return out;
}

}  // namespace cavum
