// The drop, from physics: exam, tooth and motion are known, so the same motion is simulated once
// more in the tooth whose cavity is filled with the tissue around it. The force that is missing,
// tick by tick, is what the cavity took away; no hand, no detector and no threshold of theirs is in
// it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/physics/servo/servo.h"
#include "engine/session/session.h"
#include "grading/result/result.h"

namespace cavum::grading {

/// A drop as steep as this can be felt: so much of the force went ...
inline constexpr double k_felt_drop_n = 0.1;
/// ... and so much of what the filled tooth would give ...
inline constexpr double k_felt_drop_share = 0.3;
/// ... within so long.
inline constexpr std::int64_t k_felt_drop_ticks = 1500;

/// Force of the filled tooth over the force felt, in frames of 10 ms (means over 30 ms).
struct MissingForce {
  std::vector<double> felt_n, filled_n;
};

/// Simulates `inputs` from `state` on, and pairs each force with the recorded one. `inputs` and
/// `records` have equal length.
[[nodiscard]] MissingForce missing_force(const ServoModel& filled_model, ServoState filled,
                                         std::span<const TickInput> inputs,
                                         std::span<const TickRecord> records);
/// Its two halves, the second from a session's setup. Throws Error when the setup cannot be
/// simulated.
[[nodiscard]] std::vector<double> felt_force_n(std::span<const TickRecord> records);
[[nodiscard]] std::vector<double> filled_force_n(const SessionSetup& setup, const Tooth& filled,
                                                 std::span<const TickInput> inputs);

/// `opened`: ticks in which the cavity was opened further, ascending; a drop counts from 0.5 s
/// before one to 1.5 s after it. What `missing` holds beyond `last_asked_tick` changes nothing.
[[nodiscard]] ForceDrop find_drop(const MissingForce& missing,
                                  std::span<const std::int64_t> opened);
[[nodiscard]] std::int64_t last_asked_tick(std::span<const std::int64_t> opened);

}  // namespace cavum::grading
