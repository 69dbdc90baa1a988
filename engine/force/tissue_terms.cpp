#include "engine/force/tissue_terms.h"

#include <algorithm>

#include "engine/base/det_math.h"

namespace cavum {

TermForce HiddenLayer::evaluate(const TermInput& in, TermMemory&) const noexcept {
  return {dk_n_per_mm_ * std::max(0.0, in.penetration_mm - d0_mm_), 0.0};
}

TermForce GradedStiffness::evaluate(const TermInput& in, TermMemory&) const noexcept {
  return {-in.stiffness_n_per_mm * alpha_per_mm_ * in.penetration_mm * in.penetration_mm, 0.0};
}

TermForce NonlinearStiffness::evaluate(const TermInput& in, TermMemory&) const noexcept {
  return {in.stiffness_n_per_mm * (det_pow(in.penetration_mm, m_) - in.penetration_mm), 0.0};
}

TermForce FeedPowerLaw::evaluate(const TermInput& in, TermMemory&) const noexcept {
  const double v = in.approach_mm_s, size = det_pow(v < 0 ? -v : v, n_);
  return {in.damping_n_s_per_mm * ((v < 0 ? -size : size) - v), 0.0};
}

TermForce Relaxation::evaluate(const TermInput& in, TermMemory& memory) const noexcept {
  if (!in.touching) {
    memory = {};
    return {};
  }
  const double moved_mm = in.penetration_mm - memory[2];
  memory[2] = in.penetration_mm;
  double force_n = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (k_n_per_mm_[i] == 0.0) continue;
    const double u = in.dt_s / tau_s_[i], kept = det_exp(-u);  // exact for a constant speed within the tick
    memory[i] = memory[i] * kept + moved_mm * (u > 0.0 ? (1.0 - kept) / u : 1.0);
    force_n += k_n_per_mm_[i] * memory[i];
  }
  return {force_n, 0.0};
}

TermForce EdgeForce::evaluate(const TermInput& in, TermMemory&) const noexcept { return {in.touching && in.rpm > 0.0 ? edge_n_ : 0.0, 0.0}; }

const TermKind k_hidden_layer{"hidden_layer",
                              {{"dk_n_per_mm", -100, 100, {}}, {"d0_mm", 0, 100, {}}},
                              [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<HiddenLayer>(p[0], p[1]); }};
const TermKind k_graded_stiffness{"graded_stiffness", {{"alpha_per_mm", -100, 100, {}}}, [](const std::vector<double>& p) -> ForceTermPtr {
                                    return std::make_shared<GradedStiffness>(p[0]);
                                  }};
const TermKind k_nonlinear_stiffness{"nonlinear_stiffness", {{"m", 0.1, 5, {}}}, [](const std::vector<double>& p) -> ForceTermPtr {
                                       return std::make_shared<NonlinearStiffness>(p[0]);
                                     }};
const TermKind k_feed_power_law{
    "feed_power_law", {{"n", 0.05, 4, {}}}, [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<FeedPowerLaw>(p[0]); }};
const TermKind k_relaxation{"relaxation",
                            {{"k1_n_per_mm", -100, 100, {}}, {"tau1_s", 1e-3, 1e4, {}}, {"k2_n_per_mm", -100, 100, 0.0}, {"tau2_s", 1e-3, 1e4, 1.0}},
                            [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<Relaxation>(p[0], p[1], p[2], p[3]); }};
const TermKind k_edge_force{
    "edge_force", {{"edge_n", -100, 100, {}}}, [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<EdgeForce>(p[0]); }};

}  // namespace cavum
