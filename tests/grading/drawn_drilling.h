// Drilling as it might happen: a hand of drawn speed, force and tremor on a simulated Omni, in one of our teeth or a block, doing
// one of the things that look like a breakthrough, and in half of the sessions breaking through as well. Closed loop, real physics.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/servo/servo.h"

namespace cavum::testing_grading {

enum class LookAlike { steady, lift_off, pedal_release, enamel_to_dentin, earlier_cut, soft_lesion, change_of_point, saturation, slip, look };
inline constexpr int k_look_alikes = 10;
[[nodiscard]] const char* name_of(LookAlike what);

struct DrawnSession {
  LookAlike what = LookAlike::steady;
  std::string tooth, point;  ///< of the first part
  std::string story;         ///< what was drawn, for a failing test
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;  ///< with noise on the force
  std::vector<DiamondPoint> tray;
  std::vector<float> true_n;                ///< size of the rendered force without noise, per tick
  std::vector<std::uint16_t> void_leaves;  ///< leaves of the cavity that went, per tick
  std::int64_t pressed_from = -1, pressed_to = -1;  ///< ticks in which the hand presses on into the cavity
  std::int64_t touched = -1;      ///< tick in which the first leaf of pulp or periodontium went; -1 = never
  std::int64_t fallen = -1;       ///< tick in which the hand, pressing on, felt the force fall under 10 % of its level
  bool grazed_elsewhere = false;  ///< void tissue went beside the way, before the cavity was touched
  bool quick = false;             ///< it fell from 80 to 10 % within 1.5 s, and was at least 0.12 N before; else the point crept through
};

/// Draws session `seed`; equal seeds give equal sessions.
[[nodiscard]] DrawnSession draw_session(std::uint64_t seed);

}  // namespace cavum::testing_grading
