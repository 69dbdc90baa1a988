// A stylus and a foot pedal as one device of the servo.
#pragma once

#include "engine/device/pedal.h"
#include "engine/physics/servo/servo_device.h"

namespace cavum {

class WithPedal final : public ServoDevice {
 public:
  /// Both must outlive it. What the stylus says of a pedal does not count.
  WithPedal(ServoDevice& stylus, Pedal& pedal) : stylus_(stylus), pedal_(pedal) {}

  [[nodiscard]] DeviceReading read(double elapsed_s) override {
    DeviceReading reading = stylus_.read(elapsed_s);
    const PedalReading foot = pedal_.read();
    reading.pedal = foot.position;
    reading.flags = static_cast<std::uint16_t>((reading.flags & ~k_pedal_fresh) |
                                               (foot.fresh ? k_pedal_fresh : 0));
    return reading;
  }
  void show(const TickOutput& output) noexcept override { stylus_.show(output); }
  void send_force(Vec3 force_n) override { stylus_.send_force(force_n); }
  void cut_force() noexcept override { stylus_.cut_force(); }

 private:
  ServoDevice& stylus_;
  Pedal& pedal_;
};

}  // namespace cavum
