#include "engine/physics/force/run_out.h"

#include <cmath>

#include "engine/physics/force/term_laws.h"

namespace cavum {

TermForce RunOut::evaluate(const TermInput& in, TermMemory& memory) const noexcept {
  double& turns = memory[0];
  turns += rate_ratio_ * in.rpm * (in.dt_s / 60.0);
  turns -= std::floor(turns);
  if (in.rpm <= 0.0) return {};
  double now = turns;
  if (by_clock_) {
    now = rate_ratio_ * in.rpm / 60.0 * in.time_s;
    now -= std::floor(now);
  }
  return {(amplitude_n_ + eccentricity_mm_ * in.stiffness_n_per_mm) * line_at(now + phase_turns_), 0.0};
}

const TermKind k_run_out{"run_out",
                         {{"amplitude_n", 0, 100, 0.0},
                          {"eccentricity_um", 0, 1000, 0.0},
                          {"phase_turns", 0, 1, 0.0},
                          {"by_clock", 0, 1, 0.0},
                          {"rate_ratio", 0.9, 1.1, 1.0}},
                         [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<RunOut>(p[0], p[1], p[2], p[3] >= 0.5, p[4]); }};

}  // namespace cavum
