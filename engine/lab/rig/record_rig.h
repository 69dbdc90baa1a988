// The testing machine as a source of recordings for `cavum explain`: its crosshead follows a motion
// (such as the protocol's) into a cube of dentin, once for each session at a new place, and its
// load cell writes down what the servo renders.
#pragma once

#include <string>
#include <vector>

#include "engine/base/random.h"
#include "engine/device/motion_file.h"
#include "engine/physics/servo/servo.h"

namespace cavum {

struct RecordOptions {
  int sessions = 6;
  double rate_hz = 200.0;  ///< of the rows; the servo runs at 1 kHz
  double noise_n = 0.02;   ///< sd of a reading of the load cell (assumed)
  std::uint64_t seed = 1;  ///< of noise and places
};

/// One row: x is X in contact, in air minus the distance to the surface as it was left; v is the
/// way of the crosshead, positive = down.
struct RecordRow {
  int session = 0;
  double t_s = 0, x_mm = 0, f_n = 0, v_mm_s = 0, rpm = 0, removed_mm3 = 0;
};

struct RecordResult {
  std::vector<RecordRow> rows;
  double k_n_per_mm = 0, c_n_s_per_mm = 0, force_limit_n = 0;  ///< of the cube; of the device
};

/// Heights of `motion` (its z) count from the surface of the cube; where cutting has lowered it,
/// the crosshead follows while it is in air, at 0.5 mm/s at most. Each session is a new place on a
/// cube, the bur stays. No friction of joints: the load cell holds the cube. Rows in which only
/// wall or rim of the hole press on the head are left out. Throws Error when the
/// motion goes deeper than 3 mm, or the model has no material "dentin".
[[nodiscard]] RecordResult run_record_rig(const Motion& motion, const ForceModel& force,
                                          const Bur& bur, const RecordOptions& options);

/// session,t_s,x_mm,f_n,v_mm_s,spindle_rpm,removed_mm3
[[nodiscard]] std::string record_csv(const RecordResult& result);
/// rig.toml to stand beside it.
[[nodiscard]] std::string record_rig_toml(const RecordResult& result);

}  // namespace cavum
