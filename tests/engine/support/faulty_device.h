// A device that does to the servo what real ones do: sleeps, falls silent, gives NaN, throws. It
// presses steadily, and keeps what was sent to it.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>
#include <vector>

#include "engine/physics/servo/scheduling.h"
#include "engine/physics/servo/servo_device.h"

namespace cavum::testing_engine {

class FaultyDevice final : public ServoDevice {
 public:
  /// May change the n-th reading, wait, or throw.
  using Fault = std::function<void(std::int64_t n, DeviceReading& reading)>;
  struct Sent {
    std::int64_t read = 0;  ///< number of the reading it answers
    Vec3 force_n;
  };

  FaultyDevice(std::function<Pose(double t_s)> path, double pedal, Fault fault)
      : path_(std::move(path)), pedal_(pedal), fault_(std::move(fault)) {
    sent.reserve(1 << 16);
  }
  [[nodiscard]] DeviceReading read(double elapsed_s) override {
    time_s_ += elapsed_s;
    DeviceReading r{path_(time_s_), pedal_, k_stylus_fresh | k_pedal_fresh, 0};
    const std::int64_t n = reads++;
    if (fault_) fault_(n, r);
    return r;
  }
  void send_force(Vec3 force_n) override {
    sent.push_back({reads - 1, force_n});
    is_cut = false;
    sent_ns = monotonic_ns();
  }
  void cut_force() noexcept override {
    if (!is_cut.exchange(true) && cut_after_ns < 0) cut_after_ns = monotonic_ns() - sent_ns;
  }

  /// Time that has passed by the servo's schedule, up to the reading under way.
  [[nodiscard]] double time_s() const noexcept { return time_s_; }

  std::vector<Sent> sent;  ///< servo thread; read after join
  std::int64_t reads = 0;
  std::atomic<bool> is_cut{false};
  std::atomic<std::int64_t> sent_ns{0},
      cut_after_ns{-1};  ///< when the force was first cut, after the last one sent

 private:
  std::function<Pose(double)> path_;
  double pedal_;
  Fault fault_;
  double time_s_ = 0.0;
};

inline void wait_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

}  // namespace cavum::testing_engine
