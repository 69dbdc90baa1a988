#include "engine/physics/force/loop_terms.h"

#include "engine/physics/force/term_laws.h"

namespace cavum {

TermForce Hysteresis::evaluate(const TermInput& in, TermMemory& memory) const noexcept {
  if (!in.touching) {
    memory = {};
    return {};
  }
  const double moved_mm = in.dt_s > 0.0 ? in.penetration_mm - memory[1] : 0.0;  // begun in contact: the loop is empty
  memory[1] = in.penetration_mm;
  memory[0] = loop_mm(memory[0], moved_mm, d_mm_, gamma_);
  return {alpha_n_per_mm_ * memory[0], 0.0};
}

TermForce Backlash::evaluate(const TermInput& in, TermMemory& memory) const noexcept {
  if (!in.touching) {
    memory = {-behind_mm_, 0.0, 0.0, 0.0};
    return {};
  }
  if (in.dt_s <= 0.0) memory[0] = in.penetration_mm;  // begun in contact: the tip is where it is seen
  memory[0] = played_mm(memory[0], in.penetration_mm, behind_mm_, ahead_mm_);
  return {in.stiffness_n_per_mm * ((seen_ ? memory[0] : std::max(0.0, memory[0])) - in.penetration_mm), 0.0};
}

const TermKind k_hysteresis{"hysteresis",
                            {{"alpha_n_per_mm", 0, 100, {}}, {"d_mm", 1e-6, 100, {}}, {"gamma", 0, 0.5, 0.0}},
                            [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<Hysteresis>(p[0], p[1], p[2]); }};
const TermKind k_backlash{"backlash",
                          {{"b_mm", 0, 100, {}}, {"ahead_mm", 0, 100, -1.0}, {"seen", 0, 1, 0.0}},
                          [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<Backlash>(p[0], p[1], p[2] >= 0.5); }};

}  // namespace cavum
