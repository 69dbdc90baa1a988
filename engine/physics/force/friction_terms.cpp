#include "engine/physics/force/friction_terms.h"

#include "engine/physics/force/term_laws.h"

namespace cavum {

TermForce ViscousFriction::evaluate(const TermInput& in, TermMemory&) const noexcept { return {0.0, b_ * in.speed_mm_s}; }

TermForce StribeckFriction::evaluate(const TermInput& in, TermMemory&) const noexcept {
  return {0.0, (fc_n_ + (fs_n_ - fc_n_) * static_share(in.speed_mm_s, vs_mm_s_)) * sliding_share(in.speed_mm_s, v0_mm_s_)};
}

const TermKind k_viscous_friction{"viscous_friction", {{"b_n_s_per_mm", 0, 100, {}}}, [](const std::vector<double>& p) -> ForceTermPtr {
                                    return std::make_shared<ViscousFriction>(p[0]);
                                  }};

const TermKind k_stribeck_friction{
    "stribeck_friction",
    {{"fc_n", 0, 100, {}}, {"fs_n", 0, 100, {}}, {"vs_mm_s", 1e-6, 1000, {}}, {"v0_mm_s", 1e-6, 1000, 0.01}},
    [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<StribeckFriction>(p[0], p[1], p[2], p[3]); }};

}  // namespace cavum
