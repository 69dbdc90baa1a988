// Recorded or scripted motion as a CSV file, read whole and checked before the exam starts, then
// played tick by tick. Columns: t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal and optionally b1,b2,bur
// (number in the tray); any order, any rate. Line ends of every kind and the byte order mark of
// spreadsheets are accepted. `# bur = round-1.0` before the header chooses the bur, `#
// position_quantum_mm = 0.055` says by what step the device that it came from reports its position
// (0, or no such line: exact).
// `# first_tip_mm = 1.5 0 2` says where the servo starts, if not at the first row.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/named_enum.h"
#include "engine/base/pose.h"
#include "engine/physics/servo/tick.h"

namespace cavum {

// What a file of a motion can have wrong; faults of its CSV bear none of these.
// clang-format off
#define CAVUM_MOTION_ERRORS(ERROR) \
  ERROR(not_text) \
  ERROR(unknown_column) \
  ERROR(column_unit)    /* another than ours, or none */ \
  ERROR(column_twice) \
  ERROR(column_missing) \
  ERROR(not_a_number) \
  ERROR(not_finite) \
  ERROR(time)           /* before 0, or no seconds */ \
  ERROR(time_order) \
  ERROR(too_long) \
  ERROR(too_short) \
  ERROR(in_metres) \
  ERROR(too_far) \
  ERROR(rotation) \
  ERROR(pedal) \
  ERROR(button) \
  ERROR(bur) \
  ERROR(setting)        /* in a comment, `# NAME = VALUE` */ \
  ERROR(no_reading)     /* of the device, in a session to be written as a motion */
// clang-format on
CAVUM_NAMED_ENUM(MotionError, CAVUM_MOTION_ERRORS)

struct MotionSample {
  double t_s = 0;
  Pose pose;         ///< tip and rotation (tool to tooth), tooth frame
  double pedal = 0;  ///< 0..1
  bool button_1 = false, button_2 = false;
  int bur = -1;  ///< number in the tray; -1 = the one already mounted
};

struct Motion {
  std::vector<MotionSample> samples;  ///< t_s grows strictly
  std::string bur;                    ///< from the header comment; empty = none named
  double position_quantum_mm = 0;     ///< from the header comment; 0 = exact
  std::optional<Vec3>
      first_tip_mm;  ///< where the servo starts, from the header comment; none: at the first sample

  [[nodiscard]] double duration_s() const noexcept {
    return samples.back().t_s - samples.front().t_s;
  }
  /// Pose and pedal at `t_s` after the first sample: linear between samples (rotations normalised),
  /// ends held.
  [[nodiscard]] MotionSample at(double t_s) const noexcept;
};

/// Throws Error(where:line, ...) on a missing or unknown column, a wrong unit, NaN, a pedal outside
/// 0..1, time that is negative, does not grow, or goes on for more than a day, a rotation without
/// direction, or a way that cannot be millimetres.
[[nodiscard]] Motion parse_motion(const std::string& text, const std::string& where);
/// Of the comments before the header alone: for asking before a long motion is read. Throws Error
/// as parse_motion does.
[[nodiscard]] double motion_quantum_mm(const std::string& text, const std::string& where);
/// The inputs of a recorded exam, one for each tick, as a motion file that gives the same inputs
/// again, bit for bit. Throws Error(where, ...) where a tick had no fresh pose or pedal, which no
/// motion file can say.
[[nodiscard]] std::string motion_text(std::span<const TickInput> inputs, Vec3 first_tip_mm,
                                      double position_quantum_mm, const std::string& where);
/// Line, from 1, on which sample `sample` stands in a text that parse_motion has accepted.
[[nodiscard]] int line_of_sample(const std::string& text, std::size_t sample);

}  // namespace cavum
