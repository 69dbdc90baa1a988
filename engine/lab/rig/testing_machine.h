// A virtual materials testing machine: its crosshead holds the stylus, moves it straight down at
// constant speed, and its load cell reads what the stylus resists with: the force that the real
// servo step renders, and the friction of the stylus's joints, which always acts against the way.
// As in Figures 6 and 9 of the HAP-DENT paper.
#pragma once

#include "engine/base/message.h"
#include "engine/base/random.h"
#include "engine/device/simulated_omni.h"
#include "engine/lab/rig/published.h"
#include "engine/physics/servo/servo.h"

namespace cavum {

struct MachineSettings {
  double speed_mm_s = k_paper_speed_mm_s;
  OmniModel
      omni;  ///< friction, encoder and saturation; mass and delay do not show at constant speed
  double noise_n = 0.01;  ///< sd of a reading of the load cell (assumed: the paper gives none)
  double zero_n = 0.01;   ///< sd of the zero error that each run has of its own (assumed)
};

/// What the machine knows after a tick. Forces are positive when they resist the crosshead.
struct MachineReading {
  double t_s = 0.0;         ///< since the crosshead started
  double crosshead_mm = 0;  ///< z of the tip
  double motor_n = 0.0;     ///< rendered, along the feed
  double force_n = 0.0;     ///< load cell: motors + joint friction + zero error + noise
  double exact_n = 0.0;     ///< motors + joint friction: the load cell without its errors
  TickOutput servo;
};

/// One run. The handpiece turns at full speed from the start unless it is held still.
class TestingMachine {
 public:
  /// The tip starts at `start_mm`, handle up. `random` gives this run's encoder phase, zero error
  /// and noise.
  TestingMachine(const ServoModel& model, const Tooth& tooth, Vec3 start_mm,
                 const MachineSettings& settings, Random random, bool turning = true);
  const MachineReading& tick() noexcept;
  [[nodiscard]] const ServoState& state() const noexcept { return state_; }

 private:
  const ServoModel& model_;
  ServoState state_;
  MachineSettings settings_;
  Random random_;
  Vec3 start_mm_;
  double encoder_phase_mm_ = 0.0, zero_n_ = 0.0, pedal_ = 1.0;
  TickInput input_;
  MachineReading reading_;
};

/// Friction, errors and encoder of the load cell, as a line.
[[nodiscard]] Message load_cell_words(const MachineSettings& settings);

/// `model` with another stiffness of one tissue. The damping keeps its ratio, c = c0 √(k/k0): from
/// `paper` this gives eq. 5 for every k, from `consistent` the critical damping of the stylus.
/// Throws Error when the tissue has no material or k0 = 0.
[[nodiscard]] ForceModel with_stiffness(ForceModel model, const std::string& tissue,
                                        double k_n_per_mm);

/// Throws Error when the model cuts by pressure: the paper's feed of 0.25 mm/s is ten times what a
/// dentist's force grinds enamel at, and has no τ.
void require_penetration(const ForceModel& model);

/// A servo for a machine: one bur, the limits of the Omni, and, as in an exam with one, told the
/// step of its encoder.
[[nodiscard]] ServoModel machine_servo(const Tooth& tooth, const Bur& bur, const ForceModel& force,
                                       const OmniModel& omni);

}  // namespace cavum
