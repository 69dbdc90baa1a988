#include "engine/physics/force/tissue_terms.h"

#include "engine/physics/force/term_laws.h"

namespace cavum {

TermForce HiddenLayer::evaluate(const TermInput& in, TermMemory&) const noexcept { return {dk_n_per_mm_ * layer_mm(in.penetration_mm, d0_mm_), 0.0}; }

TermForce GradedStiffness::evaluate(const TermInput& in, TermMemory&) const noexcept {
  return {graded_n(in.stiffness_n_per_mm, alpha_per_mm_, in.penetration_mm), 0.0};
}

TermForce NonlinearStiffness::evaluate(const TermInput& in, TermMemory&) const noexcept {
  return {in.stiffness_n_per_mm * power_beyond_mm(in.penetration_mm, m_), 0.0};
}

TermForce FeedPowerLaw::evaluate(const TermInput& in, TermMemory&) const noexcept {
  return {in.damping_n_s_per_mm * feed_beyond_mm_s(in.approach_mm_s, n_), 0.0};
}

TermForce Relaxation::evaluate(const TermInput& in, TermMemory& memory) const noexcept {
  if (!in.touching) {
    const TermMemory before = memory;
    memory = {};
    for (std::size_t i = 0; i < 2 && carried_; ++i) memory[i] = relaxed_mm(before[i], 0.0, in.dt_s / tau_s_[i]);
    return {};
  }
  const double stretch = exponent_ == 1.0 ? in.penetration_mm : det_pow(in.penetration_mm, exponent_);
  const double moved_mm = in.dt_s > 0.0 ? stretch - memory[2] : 0.0;  // begun in contact: at rest since long ago
  memory[2] = stretch;
  double force_n = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (k_n_per_mm_[i] == 0.0) continue;
    memory[i] = relaxed_mm(memory[i], moved_mm, in.dt_s / tau_s_[i]);
    force_n += k_n_per_mm_[i] * memory[i];
  }
  return {force_n, 0.0};
}

TermForce EdgeForce::evaluate(const TermInput& in, TermMemory&) const noexcept { return {in.touching && in.rpm > 0.0 ? edge_n_ : 0.0, 0.0}; }

TermForce Anisotropy::evaluate(const TermInput& in, TermMemory&) const noexcept {
  if (!in.touching) return {};
  return {(epsilon_ * in.voigt_n + amplitude_n_) * turned_share(in.approach, phi0_), 0.0};
}

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
const TermKind k_relaxation{
    "relaxation",
    {{"k1_n_per_mm", -100, 100, {}},
     {"tau1_s", 1e-3, 1e4, {}},
     {"k2_n_per_mm", -100, 100, 0.0},
     {"tau2_s", 1e-3, 1e4, 1.0},
     {"exponent", 0.2, 5, 1.0},
     {"carried", 0, 1, 0.0}},
    [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<Relaxation>(p[0], p[1], p[2], p[3], p[4], p[5] >= 0.5); }};
const TermKind k_edge_force{
    "edge_force", {{"edge_n", -100, 100, {}}}, [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<EdgeForce>(p[0]); }};
const TermKind k_anisotropy{"anisotropy",
                            {{"epsilon", -1, 1, 0.0}, {"amplitude_n", -100, 100, 0.0}, {"phi0_deg", -180, 180, 0.0}},
                            [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<Anisotropy>(p[0], p[1], p[2]); }};

}  // namespace cavum
