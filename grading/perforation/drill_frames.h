// What the detector of breakthroughs looks at: means over ten ticks of what a device gives, and how
// noisy its force is.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/vec.h"
#include "engine/physics/servo/tick.h"

namespace cavum::grading {

inline constexpr std::int64_t k_frame_ticks = 10;
inline constexpr double k_frame_s = k_frame_ticks * k_tick_s;
inline constexpr std::int64_t k_mean_frames =
    3;  ///< over which the force is averaged where it is judged
[[nodiscard]] constexpr std::int64_t frames_in(double seconds) noexcept {
  return static_cast<std::int64_t>(seconds / k_frame_s + 0.5);
}

/// Means over ten ticks.
struct DrillFrame {
  Vec3 tip_mm, force_n;
  Vec3 handle;              ///< unit, along the tool towards the hand
  double scatter_n2 = 0.0;  ///< variance of the force over the ticks of the frame, sum of the axes
  double noise_n2 =
      0.0;  ///< the part of it that is the device's noise, as estimated from the frames until now
  bool cutting_possible = true;  ///< handpiece and pedal on, same bur
};

/// `inputs` and `records` have equal length; what is left over at the end is dropped.
[[nodiscard]] std::vector<DrillFrame> drill_frames(std::span<const TickInput> inputs,
                                                   std::span<const TickRecord> records);

/// The mean force over frames [last - count + 1, last], N.
[[nodiscard]] Vec3 mean_force_n(std::span<const DrillFrame> frames, std::int64_t last,
                                std::int64_t count) noexcept;
/// Its size without what noise adds to it, N.
[[nodiscard]] double force_size_n(std::span<const DrillFrame> frames, std::int64_t last,
                                  std::int64_t count) noexcept;

}  // namespace cavum::grading
