#include "engine/physics/force/cutting_terms.h"

#include <cmath>

#include "engine/physics/force/term_laws.h"

namespace cavum {

TermForce Wear::evaluate(const TermInput& in, TermMemory&) const noexcept {
  return {per_mm3_ * worn_n(in.voigt_n, carried_ ? in.removed_on_mm3 : in.removed_mm3), 0.0};
}

TermForce Chatter::evaluate(const TermInput& in, TermMemory&) const noexcept {
  if (!in.touching || (spinning_ && in.rpm <= 0.0)) return {};
  const double turns = frequency_hz_ * in.time_s;
  return {amplitude_n_ * line_at(turns - std::floor(turns) + phase_turns_), 0.0};
}

TermForce Coolant::evaluate(const TermInput& in, TermMemory&) const noexcept { return {fraction_ * watered_n(in.voigt_n, in.wet), 0.0}; }

TermForce ThermalSoftening::evaluate(const TermInput& in, TermMemory& memory) const noexcept {
  if (in.warmth_known) return {per_k_ * warmed_n(in.voigt_n, in.warmer_k), 0.0};
  const double heated = in.touching && in.rpm > 0.0 ? heating_k_per_n_s_ * in.voigt_n * in.dt_s : 0.0;  // K, as if nothing cooled
  memory[0] = relaxed_mm(memory[0], heated, in.dt_s / cooling_s_);                                      // the same equation as a branch's stretch
  return {per_k_ * warmed_n(in.voigt_n, memory[0]), 0.0};
}

const TermKind k_wear{"wear", {{"per_mm3", -100, 100, {}}, {"carried", 0, 1, 0.0}}, [](const std::vector<double>& p) -> ForceTermPtr {
                        return std::make_shared<Wear>(p[0], p[1] >= 0.5);
                      }};
const TermKind k_chatter{"chatter",
                         {{"amplitude_n", 0, 100, {}}, {"frequency_hz", 0, 1e5, {}}, {"phase_turns", 0, 1, 0.0}, {"spinning", 0, 1, 0.0}},
                         [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<Chatter>(p[0], p[1], p[2], p[3] >= 0.5); }};
const TermKind k_coolant{
    "coolant", {{"fraction", -1, 10, {}}}, [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<Coolant>(p[0]); }};
const TermKind k_thermal_softening{"thermal_softening",
                                   {{"per_k", -10, 10, {}}, {"heating_k_per_n_s", 0, 1e4, 1.0}, {"cooling_s", 1e-3, 1e5, 20.0}},
                                   [](const std::vector<double>& p) -> ForceTermPtr { return std::make_shared<ThermalSoftening>(p[0], p[1], p[2]); }};

}  // namespace cavum
