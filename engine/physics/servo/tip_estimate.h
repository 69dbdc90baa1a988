// Where the tip is between two steps of the device's encoder, and how fast it may be. A reading
// says only that the tip lies within half a quantum of it. Taken literally, a creeping tip moves in
// steps of 0.055 mm, and each is a step of the force. Speed from the time between steps:
// Janabi-Sharifi, Hayward and Chen, IEEE Trans. Control Systems Technology, 2000 (recalled).
#pragma once

#include <array>
#include <cstdint>

#include "engine/base/state_hash.h"
#include "engine/base/vec.h"

namespace cavum {

/// By axis. A step is a change of the reading by more than half a quantum since the last step.
/// Plain, to be copied and hashed.
struct TipEstimate {
  Vec3 tip_mm, speed_mm_s;
  std::array<std::int64_t, 3> step_nm{};     ///< reading at the last step
  std::array<std::int64_t, 3> travel_nm{};   ///< of the last step
  std::array<std::int64_t, 3> step_tick{};   ///< when it was
  std::array<std::int64_t, 3> step_ticks{};  ///< time T1 between the last two
};
CAVUM_STATE(TipEstimate, tip_mm, speed_mm_s, step_nm, travel_nm, step_tick, step_ticks)
[[nodiscard]] TipEstimate make_tip_estimate(std::array<std::int32_t, 3> reading_nm) noexcept;

/// One tick: s = clamp(s + V·dt, reading − q/2, reading + q/2) with V = way of the last step / T1,
/// and 0 after a reversal, when the same border was crossed twice. At constant speed s is the true
/// place; a tip at rest, or a reading that flickers over a border, leaves it where it is. With
/// `quantum_mm` = 0 it is the reading, bit for bit.
void update_tip_estimate(TipEstimate& state, std::array<std::int32_t, 3> reading_nm,
                         std::int64_t tick, double quantum_mm, double dt_s) noexcept;

/// The most that the tip's speed along the unit vector `direction` can be by the last steps: 2
/// |way|/T1 · min(1, T1/T)² by axis, T being the time since the last step. So a tip at constant
/// speed stays below half of it, and once the next step is overdue it falls. Infinite when
/// `quantum_mm` is 0.
[[nodiscard]] double fastest_mm_s(const TipEstimate& state, Vec3 direction, std::int64_t tick,
                                  double quantum_mm, double dt_s) noexcept;

}  // namespace cavum
