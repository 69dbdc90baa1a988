// Drilling as it might happen: a hand of drawn speed, force and tremor on a simulated Omni, in one
// of our teeth or a block, doing one of the things that look like a breakthrough, and in half of
// the sessions breaking through as well. Closed loop, real physics.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/physics/servo/servo.h"

namespace cavum::testing_grading {

enum class LookAlike {
  steady,
  lift_off,
  pedal_release,
  enamel_to_dentin,
  earlier_cut,
  soft_lesion,
  change_of_bur,
  saturation,
  slip,
  look
};
inline constexpr int k_look_alikes = 10;
[[nodiscard]] const char* name_of(LookAlike what);

/// Whence a session is drawn. `shifted` lies beyond what is usual: mostly the other force model,
/// joint friction and noise at the ends of their ranges, hands softer and stiffer, slower and
/// faster, more aslant, lesions softer.
enum class Drawn { usual, shifted };

/// A fall of the force can be felt when less than this share is left of what solid tissue would
/// give at the same motion of the tip ...
inline constexpr double k_felt_share = 0.2;
/// ... while the hand presses on, and that would be at least so much, and half of the level before
/// the touch ...
inline constexpr double k_felt_least_n = 0.1;
/// ... with the head at the bottom of its hole, not thrown out of it ...
inline constexpr double k_felt_near_mm = 0.2;
/// ... and nearly all of the level was there so shortly before: what fades over longer than that is
/// no fall.
inline constexpr std::int64_t k_felt_within_ticks = 3000;

struct DrawnSession {
  LookAlike what = LookAlike::steady;
  std::string tooth, bur;  ///< of the first part
  std::string story;       ///< what was drawn, for a failing test
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;  ///< with noise on the force
  std::vector<Bur> tray;
  std::int64_t touched =
      -1;  ///< tick in which the first leaf of pulp or periodontium went; -1 = never
  std::int64_t felt =
      -1;  ///< first tick after that in which the fall could be felt (k_felt_share); -1 = never
  double least_share = 1.0;  ///< least of the expected force that was left after the touch
  bool grazed_elsewhere =
      false;  ///< void tissue went beside the way, before the cavity was touched
};

/// Draws session `seed`; equal seeds give equal sessions.
[[nodiscard]] DrawnSession draw_session(std::uint64_t seed, Drawn drawn = Drawn::usual);

}  // namespace cavum::testing_grading
