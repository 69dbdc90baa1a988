// Does this computer keep the servo's time? A hand on the simulated Omni drills a block for a
// minute in real time, is recorded like an exam, and every late tick is counted. Run it on a
// station before an exam day.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/base/lines.h"
#include "engine/device/simulated_stylus.h"
#include "engine/physics/servo/real_time.h"
#include "engine/session/session.h"
#include "engine/session/session_writer.h"

namespace cavum {

struct ServoRigOptions {
  double seconds = 60.0;
  RealTimeOptions real_time;
};

struct ServoRigResult {
  double tick_s = 0.0, seconds = 0.0;  ///< wall time
  RealTimeReport servo;
  WriterReport writer;
  double mean_force_n = 0.0, peak_force_n = 0.0;  ///< rendered, in contact
  std::int64_t contact_ticks = 0, removed_leaves = 0;
  double slowest_write_s = 0.0;  ///< longest second of motion to disk
  [[nodiscard]] bool on_time() const noexcept {
    return servo.overruns == 0 && servo.skipped_late == 0 && servo.skipped_full == 0;
  }
};

/// A 10 x 10 x 6 mm block of dentin under a film of enamel, one bur, ticks of `tick_s`: what
/// run_servo_rig drills.
[[nodiscard]] SessionSetup servo_rig_setup(const std::string& bur_toml,
                                           const std::string& force_model_toml,
                                           double tick_s = k_tick_s);

/// What its hand wants at a time: down to the block, then in circles, pressing, and out of contact
/// for a moment in every turn.
[[nodiscard]] HandIntent drilling_hand(double t_s);

/// Runs in real time and closes the session at `path`; its result is the JSON below. Throws Error
/// when it cannot be recorded; whatever the servo does is in the result.
[[nodiscard]] ServoRigResult run_servo_rig(const SessionSetup& setup, const std::string& path,
                                           const ServoRigOptions& options = {});

[[nodiscard]] nlohmann::json to_json(const ServoRigResult& result);
/// For a terminal: what was granted, the counts, the histogram.
[[nodiscard]] Lines to_text(const ServoRigResult& result);

}  // namespace cavum
