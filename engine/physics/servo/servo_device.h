// What the real-time loop needs of a device: where the stylus is, how far the pedal is pressed, and
// a way to push back. A simulated Omni in a simulated hand is one
// (engine/device/simulated_stylus.h); real ones follow.
#pragma once

#include <limits>

#include "engine/base/pose.h"
#include "engine/physics/servo/tick.h"

namespace cavum {

/// One reading, in the tooth frame. It may hold anything: make_tick_input sorts out what cannot be.
struct DeviceReading {
  Pose pose;
  double pedal = std::numeric_limits<double>::quiet_NaN();  ///< 0..1; anything else is unknown
  std::uint16_t flags = 0;  ///< k_stylus_fresh, k_pedal_fresh, k_button_1, k_button_2, k_hold
  std::uint8_t bur = 0;     ///< bur mounted
};

class ServoDevice {
 public:
  virtual ~ServoDevice() = default;
  /// The latest reading, `elapsed_s` after the one before by the servo's schedule. Servo thread
  /// only. It must not wait: without news it leaves out k_stylus_fresh. What it throws stops the
  /// servo with zero force.
  [[nodiscard]] virtual DeviceReading read(double elapsed_s) = 0;
  /// Force on the hand, N, tooth frame, until the next. Servo thread only. Throwing as in `read`.
  virtual void send_force(Vec3 force_n) = 0;
  /// What the step made of the last reading, before its force is sent: for a simulated candidate,
  /// who acts on what is seen and felt. Servo thread only; must neither wait nor allocate. Not
  /// called for ticks that are made up for.
  virtual void show(const TickOutput& output) noexcept { static_cast<void>(output); }
  /// No force until the next send_force. May be called by another thread while `read` or
  /// `send_force` hangs.
  virtual void cut_force() noexcept = 0;
};

}  // namespace cavum
