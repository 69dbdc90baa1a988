// The closed loop of an exam without hardware: operator, hand, simulated Omni and servo, tick by tick; and
// the same exam with a motion file in place of operator and hand.
#pragma once

#include <functional>

#include "engine/device/motion_file.h"
#include "scenarios/exam.h"
#include "scenarios/operator.h"

namespace cavum {

/// Something that gives the input of each tick.
class InputSource {
 public:
  virtual ~InputSource() = default;
  /// Where the tip is before the first tick.
  [[nodiscard]] virtual Vec3 start_mm() const noexcept = 0;
  /// Input of the next tick; `last` is the exam's last output, `previous` its last input. False when there is no more.
  [[nodiscard]] virtual bool next(const TickOutput& last, const TickInput& previous, TickInput& input) noexcept = 0;
  /// How far it has come, 0..1.
  [[nodiscard]] virtual double progress() const noexcept = 0;
};

/// Operator and hand on a simulated Omni.
class SimulatedCandidate final : public InputSource {
 public:
  SimulatedCandidate(Candidate candidate, const OmniModel& omni);
  [[nodiscard]] Vec3 start_mm() const noexcept override { return candidate_.hands.start_mm(); }
  [[nodiscard]] bool next(const TickOutput& last, const TickInput& previous, TickInput& input) noexcept override;
  [[nodiscard]] double progress() const noexcept override { return candidate_.hands.progress(); }

 private:
  Candidate candidate_;
  OmniModel omni_;
  OmniState state_;
  std::int64_t rested_ = 0;
};

/// Poses from a motion file.
class PlayedMotion final : public InputSource {
 public:
  /// `point_names` is the tray. Throws Error when the file names a diamond point that is not in it.
  PlayedMotion(Motion motion, const std::vector<std::string>& point_names, const std::string& where);
  [[nodiscard]] Vec3 start_mm() const noexcept override { return motion_.samples.front().pose.tip_mm; }
  [[nodiscard]] bool next(const TickOutput& last, const TickInput& previous, TickInput& input) noexcept override;
  [[nodiscard]] double progress() const noexcept override;

 private:
  Motion motion_;
  std::uint8_t point_ = 0;
  std::int64_t tick_ = 0;
};

/// Runs the exam until it is over or the input ends, then ends it. `watch` is called every 50 ticks.
void run_exam(Exam& exam, InputSource& input, const std::function<void(const Exam&, double progress)>& watch = {});

}  // namespace cavum
