// A simulated candidate as a device of the real-time servo: the built-in operator and its hand on a
// simulated Omni, acting on what each step shows and feels, as it does in an exam without a clock.
#pragma once

#include <atomic>

#include "engine/physics/servo/servo_device.h"
#include "scenarios/exam/exam.h"
#include "scenarios/operators/operator.h"

namespace cavum::scenarios {

class CandidateDevice final : public ServoDevice {
 public:
  CandidateDevice(Candidate candidate, const OmniModel& omni);

  [[nodiscard]] Vec3 start_mm() const noexcept { return start_mm_; }
  /// The operator has nothing left to do and has rested a moment: the exam may be ended. Any
  /// thread.
  [[nodiscard]] bool done() const noexcept { return done_.load(std::memory_order_acquire); }
  /// Done so far, 0..1. Any thread.
  [[nodiscard]] double progress() const noexcept {
    return progress_.load(std::memory_order_relaxed);
  }

  [[nodiscard]] DeviceReading read(double elapsed_s) override;
  void show(const TickOutput& output) noexcept override { seen_ = output; }
  void send_force(Vec3 force_n) override;
  void cut_force() noexcept override { cut_.store(true, std::memory_order_release); }

 private:
  Candidate candidate_;
  OmniModel omni_;
  OmniState state_;
  Vec3 start_mm_;
  TickOutput seen_;
  Vec3 force_n_;
  std::int64_t rested_ = 0;
  std::atomic<bool> cut_{false}, done_{false};
  std::atomic<double> progress_{0.0};
};

/// Operator of this skill (see make_skill) for an exam. Throws Error when no bur of its tray fits
/// into the target.
[[nodiscard]] std::unique_ptr<CandidateDevice> make_candidate_device(const ExamSetup& setup,
                                                                     const std::string& skill,
                                                                     std::uint64_t seed);

}  // namespace cavum::scenarios
