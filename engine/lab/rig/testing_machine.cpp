#include "engine/lab/rig/testing_machine.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/lab/rig/rig_error.h"

namespace cavum {
namespace {

double encoded(double mm, double quantum_mm, double phase_mm) noexcept {
  return quantum_mm > 0 ? std::floor((mm + phase_mm) / quantum_mm + 0.5) * quantum_mm - phase_mm
                        : mm;
}

}  // namespace

TestingMachine::TestingMachine(const ServoModel& model, const Tooth& tooth, Vec3 start_mm,
                               const MachineSettings& settings, Random random, bool turning)
    : model_(model),
      state_(make_servo_state(model, tooth, start_mm)),
      settings_(settings),
      random_(random),
      start_mm_(start_mm),
      pedal_(turning ? 1.0 : 0.0) {
  encoder_phase_mm_ = random_.uniform(0, settings.omni.quantum_mm);
  zero_n_ = settings.zero_n * random_.normal();
  reading_.crosshead_mm = start_mm.z;
}

const MachineReading& TestingMachine::tick() noexcept {
  const double dt = model_.config.tick_s, q = settings_.omni.quantum_mm;
  reading_.t_s = static_cast<double>(state_.tick + 1) * dt;
  reading_.crosshead_mm = start_mm_.z - settings_.speed_mm_s * reading_.t_s;
  // the place is held exactly; only the feed runs over the steps of the encoder
  const Vec3 seen{start_mm_.x, start_mm_.y, encoded(reading_.crosshead_mm, q, encoder_phase_mm_)};
  input_ = make_tick_input({seen, {}}, pedal_, k_stylus_fresh | k_pedal_fresh, 0, input_);
  reading_.servo = step(model_, state_, input_);
  reading_.motor_n = std::min(reading_.servo.rendered_force_n.z, settings_.omni.saturation_n);
  reading_.exact_n = reading_.motor_n + settings_.omni.coulomb_n +
                     settings_.omni.viscous_n_s_per_mm * settings_.speed_mm_s;
  reading_.force_n = reading_.exact_n + zero_n_ + settings_.noise_n * random_.normal();
  return reading_;
}

Message load_cell_words(const MachineSettings& s) {
  return msg(
      "Load cell: joint friction {}; noise {} and a zero error of {} for each run (both assumed); encoder {}.",
      as_n(s.omni.coulomb_n, 2), as_n(s.noise_n, 3), as_n(s.zero_n, 3),
      as_mm(s.omni.quantum_mm, 3));
}

ForceModel with_stiffness(ForceModel model, const std::string& tissue, double k_n_per_mm) {
  const auto found = model.materials.find(tissue);
  if (found == model.materials.end())
    throw Error(RigError::no_material, msg("force model '{}'", model.name),
                msg("has no material for '{}'", tissue), msg("add [materials.{}]", tissue));
  Viscoelastic& v = found->second.voigt;
  if (!(v.stiffness_n_per_mm > 0))
    throw Error(RigError::no_stiffness, msg("force model '{}'", model.name),
                msg("gives '{}' no stiffness, so its damping ratio is not known", tissue),
                msg("give it a k_n_per_mm above 0"));
  v.damping_n_s_per_mm *= std::sqrt(k_n_per_mm / v.stiffness_n_per_mm);
  v.stiffness_n_per_mm = k_n_per_mm;
  return model;
}

void require_penetration(const ForceModel& model) {
  if (model.law == CuttingLaw::pressure)
    throw Error(
        RigError::by_pressure, msg("force model '{}'", model.name),
        msg("cuts by pressure, and this experiment feeds at the paper's speed, for which it needs tau_s"),
        msg("name a model that cuts by penetration, such as paper or consistent; `cavum rig grind` measures this one"));
}

ServoModel machine_servo(const Tooth& tooth, const Bur& bur, const ForceModel& force,
                         const OmniModel& omni) {
  ServoConfig config;
  config.position_quantum_mm = omni.quantum_mm;
  return make_servo_model(tooth, {bur}, force, config);
}

}  // namespace cavum
