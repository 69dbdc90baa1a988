// A simulated PHANTOM Omni in a simulated hand, so that an exam needs no hardware: a gripped mass
// with joint friction, pulled by the hand's spring towards where the operator wants the tip, pushed
// by the force that the servo renders, and read back through a coarse encoder.
#pragma once

#include <array>

#include "engine/base/vec.h"

namespace cavum {

/// The device. Source of the defaults: published notes of several groups; the mass is (recalled).
struct OmniModel {
  double mass_kg = 0.045;
  double coulomb_n = 0.26;           ///< back-drive friction of the joints
  double viscous_n_s_per_mm = 1e-4;  ///< 0.1 N·s/m
  double quantum_mm = 0.055;         ///< of the position it reports; 0 = exact
  double saturation_n = 3.3;         ///< peak force of the motors
  int delay_ticks = 1;               ///< from command to force, 0 to 3
};

/// The hand with its finger rest, as a mass-spring-damper driven by the intended path.
struct HandModel {
  double mass_kg = 0.1;             ///< of the fingers that move with the stylus
  double stiffness_n_per_mm = 2.0;  ///< finger rest in use; 0.1 to 1 without
  double damping_n_s_per_mm = 0.1;
};

struct OmniState {
  Vec3 position_mm, velocity_mm_s;
  std::array<Vec3, 4> queued_n{};  ///< commands on their way, oldest first
  Vec3 last_intended_mm;
};
[[nodiscard]] OmniState make_omni_state(Vec3 position_mm);

/// One tick of `dt_s` (in four steps, semi-implicit): takes the force commanded by the servo and
/// where the hand wants the tip, returns the position that the encoders report. The commanded force
/// saturates.
[[nodiscard]] Vec3 advance_omni(const OmniModel& omni, const HandModel& hand, OmniState& state,
                                Vec3 commanded_n, Vec3 intended_mm, double dt_s) noexcept;

}  // namespace cavum
