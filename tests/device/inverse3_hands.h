// What the tests of the Inverse3 share: its settings for the emulated service, and a servo that
// wants a force.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "engine/device/hardware/inverse3_stylus.h"
#include "tests/device/emulated_inverse3.h"
#include "tests/engine/support/basics.h"

namespace cavum::testing_device {

using testing_basics::comes_true;

/// In the device's own frame: what goes in comes out.
inline StationStylus own_frame(const EmulatedInverse3& service, const std::string& device = {},
                               const std::string& grip = {}) {
  StationStylus s = usual_station_stylus(inverse3_kind());
  s.placement = {};
  s.settings["port"] = static_cast<double>(service.port());
  s.settings["device"] = device;
  s.settings["grip"] = grip;
  return s;
}

/// Wants a force, over and over, as a servo does.
class Servo {
 public:
  Servo(Stylus& stylus, Vec3 force_n)
      : thread_([this, &stylus, force_n] {
          for (; !stop_; std::this_thread::sleep_for(std::chrono::milliseconds(1)))
            stylus.send_force(force_n);
        }) {}
  ~Servo() {
    stop_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace cavum::testing_device
