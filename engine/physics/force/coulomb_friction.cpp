#include "engine/physics/force/coulomb_friction.h"

#include "engine/physics/force/term_laws.h"

namespace cavum {

TermForce CoulombFriction::evaluate(const TermInput& in, TermMemory&) const noexcept { return {0.0, fc_n_ * sliding_share(in.speed_mm_s, v0_mm_s_)}; }

const TermKind k_coulomb_friction{"coulomb_friction",
                                  {{"fc_n", 0, 100, {}}, {"v0_mm_s", 1e-6, 1000, {}}},
                                  [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<CoulombFriction>(p[0], p[1]); }};

}  // namespace cavum
