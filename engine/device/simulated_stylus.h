// The simulated Omni, its hand and a simulated pedal as a device of the real-time servo. The hand
// follows a path in time; the force that the servo sends is felt by the simulated mechanics, at the
// servo's own rate.
#pragma once

#include <atomic>
#include <functional>

#include "engine/device/simulated_omni.h"
#include "engine/device/stylus.h"

namespace cavum {

/// What the hand wants at a moment.
struct HandIntent {
  Vec3 tip_mm;
  double pedal = 0.0;  ///< 0..1
};

/// What a simulated Omni says of itself. Its reach is half the depth of the real one's workspace of
/// 160 x 120 x 70 mm (recalled).
[[nodiscard]] StylusFacts simulated_facts(const OmniModel& omni);

class SimulatedStylus final : public Stylus {
 public:
  /// `intent` is asked in the servo thread with the time since the start; it must not allocate.
  SimulatedStylus(const OmniModel& omni, const HandModel& hand, double tick_s,
                  std::function<HandIntent(double t_s)> intent)
      : omni_(omni),
        hand_(hand),
        tick_s_(tick_s),
        intent_(std::move(intent)),
        state_(make_omni_state(intent_(0.0).tip_mm)) {}

  [[nodiscard]] DeviceReading read(double elapsed_s) override;
  void send_force(Vec3 force_n) override;
  void cut_force() noexcept override { cut_.store(true, std::memory_order_release); }
  [[nodiscard]] const StylusFacts& facts() const noexcept override { return facts_; }
  /// Its periods are those of the simulated time.
  [[nodiscard]] StylusHealth health() const override;

 private:
  OmniModel omni_;
  HandModel hand_;
  double tick_s_;
  std::function<HandIntent(double)> intent_;
  OmniState state_;
  StylusFacts facts_ = simulated_facts(omni_);
  double time_s_ = 0.0;
  Vec3 force_n_;
  std::atomic<bool> cut_{false};
  std::atomic<std::int64_t> readings_{0}, forces_cut_{0};
};

}  // namespace cavum
