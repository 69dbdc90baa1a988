// What gives place and pedal in an exam in real time: the built-in operator on a simulated Omni, or
// a stylus that is plugged in with the station's foot pedal. With it comes what the session keeps
// of it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/base/error.h"
#include "engine/physics/servo/servo_device.h"
#include "engine/session/resume.h"
#include "scenarios/exam/exam.h"

namespace cavum::ui {

struct LiveSourceOptions {
  std::string device;         ///< id in the table of styluses
  std::string operator_name;  ///< of the simulated one
  std::uint64_t seed = 1;
  std::string bur;  ///< of a real one: name of the bur mounted; empty: the tray's first
};

class LiveSource {
 public:
  virtual ~LiveSource() = default;
  /// As the station signs it.
  [[nodiscard]] virtual MotionSource source() const = 0;
  [[nodiscard]] virtual double position_quantum_mm() const = 0;
  [[nodiscard]] virtual double peak_n() const { return 0.0; }  ///< that it bears; 0 = as usual
  [[nodiscard]] virtual double continuous_n() const { return 0.0; }  ///< the same
  /// Kept as notes of the session: what was set, and how it stood.
  [[nodiscard]] virtual Notes notes() const = 0;
  /// Makes it ready for this exam and waits until it knows where the tip is; prints what it waits
  /// for. Throws Error when that takes over a minute, or the wait is interrupted.
  virtual void begin(const scenarios::ExamSetup& setup) = 0;
  /// After `begin`.
  [[nodiscard]] virtual ServoDevice& device() = 0;
  [[nodiscard]] virtual Vec3 first_tip_mm() const = 0;
  /// The operator has nothing left to do.
  [[nodiscard]] virtual bool done() const = 0;
  /// What goes wrong at the moment, or nothing.
  [[nodiscard]] virtual std::optional<Error> problem() const { return {}; }
};

/// Throws Error when there is no such device, or what it needs is missing.
[[nodiscard]] std::unique_ptr<LiveSource> open_live_source(const LiveSourceOptions& options);

}  // namespace cavum::ui
