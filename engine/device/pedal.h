// What the servo needs of a foot pedal: how far it is pressed, and whether that is still true.
#pragma once

#include <cstdint>
#include <limits>

namespace cavum {

struct PedalReading {
  double position =
      std::numeric_limits<double>::quiet_NaN();  ///< 0 released .. 1 pressed; NaN = never heard of
  bool fresh = false;                            ///< false: the handpiece must stand still
};

class Pedal {
 public:
  virtual ~Pedal() = default;
  /// The latest position. Any thread; never waits.
  [[nodiscard]] virtual PedalReading read() noexcept = 0;
};

/// How the numbers of one axis become a position. Reversed axes have pressed < released.
struct PedalCalibration {
  int axis = 0;  ///< of those the device has, counted from 0
  std::int32_t released = 0,
               pressed =
                   0;  ///< as the device says them; equal = not calibrated: the axis' own range
  /// The device speaks only when the foot moves. Its silence then counts as a position held for as
  /// long as it is plugged in.
  bool speaks_on_change = false;
};

/// Position of `value`, 0..1; between two unequal ends.
[[nodiscard]] constexpr double pedal_position(std::int32_t value, std::int32_t released,
                                              std::int32_t pressed) noexcept {
  const double p =
      (static_cast<double>(value) - released) / (static_cast<double>(pressed) - released);
  return p < 0 ? 0.0 : p > 1 ? 1.0 : p;
}

}  // namespace cavum
