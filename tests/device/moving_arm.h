// A free arm inside an emulated device, by the clock: what the device was told to push moves it,
// and where it stands is what the device tells.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>

#include "engine/physics/servo/scheduling.h"
#include "tests/engine/device/selfcheck/free_arm.h"

namespace cavum::testing_device {

class MovingArm {
 public:
  using Model = testing_selfcheck::ArmModel;
  /// `told_n`: the force that the device gives now; `move_to_mm`: where it stands from now on.
  MovingArm(const Model& model, Vec3 at_mm, std::function<Vec3()> told_n,
            std::function<void(Vec3)> move_to_mm)
      : told_n_(std::move(told_n)),
        move_to_mm_(std::move(move_to_mm)),
        arm_(model, at_mm, 1),
        thread_([this] { run(); }) {}
  ~MovingArm() {
    stop_ = true;
    thread_.join();
  }
  /// Moves it to where it stands now, by the force told until now. A device that calls this before
  /// it hears and tells is never ahead of its arm, however late the arm's own thread is woken.
  void catch_up() {
    constexpr double k_longest_s = 0.05;
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    arm_.send_force(told_n_());
    move_to_mm_(
        arm_.read(std::min(k_longest_s, std::chrono::duration<double>(now - moved_).count()))
            .pose.tip_mm);
    moved_ = now;
  }
  MovingArm(const MovingArm&) = delete;
  MovingArm& operator=(const MovingArm&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  void run() {
    static_cast<void>(
        ask_for_fifo(70));  // where the system allows it: an arm of metal waits for nobody
    ask_for_sharp_timers();
    for (; !stop_; std::this_thread::sleep_for(std::chrono::microseconds(300))) catch_up();
    const std::lock_guard lock(mutex_);
    arm_.cut_force();
  }

  std::function<Vec3()> told_n_;
  std::function<void(Vec3)> move_to_mm_;
  std::mutex mutex_;  // of the arm and of when it was moved last
  testing_selfcheck::FreeArm arm_;
  Clock::time_point moved_ = Clock::now();
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace cavum::testing_device
