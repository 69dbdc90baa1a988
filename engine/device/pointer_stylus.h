// Mouse and keyboard as a stylus, so that a student can practise at home. They only say where the
// hand wants the tip; a simulated Omni in its hand goes there, slowed by its mass and friction and
// held back by the tooth, so contact pushes back and the same physics counts as on a station.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "engine/device/simulated_omni.h"
#include "engine/physics/servo/servo_device.h"

namespace cavum {

/// What the person at the mouse wants now.
struct PointerIntent {
  Vec3 tip_mm;            ///< tooth frame
  Quat rotation;          ///< tool to tooth
  double pedal = 0.0;     ///< 0..1
  bool button_1 = false;  ///< of the stylus
  bool button_2 = false;
};

/// The simulated Omni behind a mouse, which has no joints that rub; a coarse grid of its own would
/// be felt.
[[nodiscard]] OmniModel pointer_omni();

class PointerStylus final : public ServoDevice {
 public:
  static constexpr double k_silent_s =
      0.25;  ///< without a `want` for so long, the pedal is unknown and the handpiece stands
  static constexpr double k_fastest_mm_s =
      80.0;  ///< of the intended tip, however far the mouse jumps
  static constexpr double k_hand_follows_s = 0.02;  ///< time constant of the hand behind the mouse

  PointerStylus(const OmniModel& omni, const HandModel& hand, double tick_s,
                const PointerIntent& first);

  /// One thread, any but the servo's; never waits. Values that are not finite leave the last intent
  /// as it was.
  void want(const PointerIntent& intent) noexcept;

  [[nodiscard]] DeviceReading read(double elapsed_s) override;
  void send_force(Vec3 force_n) override;
  void cut_force() noexcept override { cut_.store(true, std::memory_order_release); }

 private:
  [[nodiscard]] bool take_intent() noexcept;

  OmniModel omni_;
  HandModel hand_;
  double tick_s_;
  OmniState state_;
  PointerIntent intent_;  // the servo thread's copy
  Vec3 followed_mm_;      // where the hand wants the tip
  double silent_s_ = 0.0;
  Vec3 force_n_;
  std::atomic<bool> cut_{false};
  // what `want` hands over: odd while it writes, so that a torn reading is seen and the last whole
  // one kept
  std::atomic<std::uint32_t> written_{0};
  std::array<std::atomic<double>, 8> shared_{};
  std::atomic<std::uint32_t> buttons_{0};
  std::uint32_t taken_ = 0;
};

}  // namespace cavum
