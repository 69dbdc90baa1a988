// Mouse and keyboard as the hand that holds the handpiece: what of the input moves the tip, what
// tilts the handpiece, what presses the pedal. The same keys, held as long, move it as far at any
// rate of pictures.
#pragma once

#include <functional>

#include "engine/base/pose.h"
#include "ui/station/input_queue.h"

namespace cavum::station {

/// What the picture makes of ways on the screen, tooth frame.
struct PointerView {
  Vec3 right{1, 0, 0}, up{0, 1, 0};  ///< along the surface, unit
  Vec3 out{0, 0, 1};                 ///< out of the cavity, unit
  double mm_per_px = 0.02;
  bool mouse = true;  ///< its way counts
};

constexpr double k_pointer_mm_s = 4.0;  ///< of a held arrow key or PgUp PgDn, after its first step
constexpr double k_pointer_step_mm = 0.05;   ///< of a tap
constexpr double k_pointer_notch_mm = 0.08;  ///< of the wheel
constexpr double k_pointer_fine = 0.2;       ///< of all this with Shift
constexpr double k_pointer_reach_mm =
    1.5;  ///< of the wanted tip below the real one, where the tooth holds it: 3 N
constexpr double k_pointer_room_mm = 6.0;     ///< of its box around the tooth
constexpr double k_pointer_back_mm_s = 12.0;  ///< of the way back above the tooth
constexpr double k_pointer_tilt_deg =
    70.0;  ///< of the handpiece at most, from upright in the cavity

/// Mouse and arrows along the surface; wheel, PgUp and PgDn in and out; with Ctrl mouse and arrows
/// tilt it; 0 makes it upright.
void move_by_pointer(const InputQueue& input, const PointerView& view, Vec3& tip_mm,
                     Quat& rotation);
/// While the tip touches: the hand presses no deeper than its arm reaches, so that it lifts off as
/// soon as it goes back. `tip_mm`: where the stylus is.
void keep_in_reach(const PointerView& view, Vec3 tip_mm, Vec3& wanted_mm);
/// Within the box `low`..`high` of the tooth and k_pointer_room_mm around it, of the tooth frame,
/// with `start`.
[[nodiscard]] Vec3 near_tooth(Vec3 low, Vec3 high, Vec3 start, Vec3 wanted_mm);

/// The way on which a tip comes back above the tooth: out, then across. Below tissue it first goes
/// aside to where nothing is above it, the shortest way there is; between walls all around,
/// straight out.
struct ReturnPath {
  Vec3 goal, out;  ///< mm, tooth frame; `out` unit
  std::function<bool(Vec3)> in_tissue;
};
/// The next `step_mm` of it from `tip_mm`; its goal when that is no further.
[[nodiscard]] Vec3 next_on_return_path(const ReturnPath& way, Vec3 tip_mm, double step_mm);
/// Space bar, or the left button where the mouse counts.
[[nodiscard]] bool pointer_pedal(const InputQueue& input, bool mouse);

}  // namespace cavum::station
