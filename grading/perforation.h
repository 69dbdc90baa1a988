// Perforation twice over: as *evidence*, from what a device gives (rendered force, pose, pedal, speed), and
// as *truth*, from the tissue that was removed. The two are found independently and then compared.
//
// The detector. While the handpiece turns, the force has a level: the median over a third of a second, the
// highest of those of the last 0.6 s (so that a slow fall cannot drag its own level down). A breakthrough is
// a fall of the smoothed force to under half of the level, within 0.6 s, during which the tip moves on against
// the force (deeper) as in steady cutting, into a place where it has not been before. A hand that eases off
// falls back, a lift-off moves the tip back, a released pedal stops the handpiece, a slip moves the tip
// sideways, a withdrawal occlusally, a cut into an earlier cavity leads where the tip has been. The time
// of the event is the last moment at which the force still had 70 % of its level: tissue is felt a leaf and a half
// ahead, so the fall begins before the tissue behind is touched. Its place is where the head was then.
#pragma once

#include <span>
#include <vector>

#include "engine/servo/tick.h"
#include "grading/grade.h"

namespace cavum {

struct DetectorSettings {
  double least_level_n = 0.15;  ///< a force below it tells nothing
  double fall = 0.5;            ///< of the level
  double onset = 0.93;          ///< of the level: from here on the tip is watched
  double time_at = 0.7;         ///< of the level: the time of the event
  int smooth_ticks = 20;        ///< mean of the force
  int level_ticks = 320;        ///< median of the smoothed force over this long ...
  int level_gap_ticks = 40;     ///< ... ending this long before now
  int longest_fall_ticks = 600;
  int hold_ticks = 30;             ///< the force stays down at least this long
  double least_advance_mm = 0.06;  ///< of the tip against the force, during the fall
  double keeps_up = 0.6;           ///< and at least this share of its advance in the same time before
  double straightness = 0.75;      ///< that advance, of the tip's whole way in the fall
  double withdrawal = 0.3;         ///< a way that rises (occlusally) by more than this share is a withdrawal
  double visited_mm = 0.2;         ///< edge of the cells in which the tip's way is remembered
  int visited_ticks = 400;         ///< a cell counts as visited when the tip was there so long before the onset
  int refractory_ticks = 400;      ///< after an event
};

/// Events seen in the force, in order of time. `fault` and `confirmed` are not set. Uses inputs' pose and pedal and records'
/// rendered force and speed, nothing else.
[[nodiscard]] std::vector<PerforationEvent> detect_breakthroughs(std::span<const TickInput> inputs, std::span<const TickRecord> records,
                                                                 const DetectorSettings& settings = {});

/// Evidence, truth and their comparison. An event is the *aim* when the scenario has aims and its place lies inside target or
/// leeway; else it is a fault. It is confirmed when a leaf of a tissue of that kind was removed within 100 ms of its time.
[[nodiscard]] PerforationMeasures measure_perforation(const GradeInput& input, std::int64_t ticks);

}  // namespace cavum
