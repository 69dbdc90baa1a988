// The closed loop of an exam without hardware: operator, hand, simulated Omni and servo, tick by
// tick; and the same exam with a motion file in place of operator and hand.
#pragma once

#include <functional>

#include "engine/device/motion_file.h"
#include "scenarios/exam/exam.h"
#include "scenarios/operators/operator.h"

namespace cavum::scenarios {

/// Something that gives the input of each tick.
class InputSource {
 public:
  virtual ~InputSource() = default;
  /// Where the tip is before the first tick.
  [[nodiscard]] virtual Vec3 start_mm() const noexcept = 0;
  /// Input of the next tick; `last` is the exam's last output, `previous` its last input. False
  /// when there is no more.
  [[nodiscard]] virtual bool next(const TickOutput& last, const TickInput& previous,
                                  TickInput& input) noexcept = 0;
  /// How far it has come, 0..1.
  [[nodiscard]] virtual double progress() const noexcept = 0;
  /// What it would still do if the exam were not over. Moves it to its end.
  struct Rest {
    std::int64_t ticks = 0, pedal_ticks = 0;
  };
  [[nodiscard]] virtual Rest rest() noexcept { return {}; }
};

/// Operator and hand on a simulated Omni.
class SimulatedCandidate final : public InputSource {
 public:
  SimulatedCandidate(Candidate candidate, const OmniModel& omni);
  /// With which the target is cut, of the tray.
  [[nodiscard]] std::uint8_t bur() const noexcept { return candidate_.bur; }
  [[nodiscard]] Vec3 start_mm() const noexcept override { return candidate_.hands.start_mm(); }
  [[nodiscard]] bool next(const TickOutput& last, const TickInput& previous,
                          TickInput& input) noexcept override;
  [[nodiscard]] double progress() const noexcept override { return candidate_.hands.progress(); }
  /// The bur of the tray that was chosen for the target.

 private:
  Candidate candidate_;
  OmniModel omni_;
  OmniState state_;
  std::int64_t rested_ = 0;
};

/// Poses from a motion file.
class PlayedMotion final : public InputSource {
 public:
  /// `bur_names` is the tray. Throws Error when the file names a bur that is not in it.
  PlayedMotion(Motion motion, const std::vector<std::string>& bur_names, const std::string& where);
  [[nodiscard]] Vec3 start_mm() const noexcept override {
    return motion_.first_tip_mm.value_or(motion_.samples.front().pose.tip_mm);
  }
  [[nodiscard]] bool next(const TickOutput& last, const TickInput& previous,
                          TickInput& input) noexcept override;
  [[nodiscard]] double progress() const noexcept override;
  [[nodiscard]] Rest rest() noexcept override;

 private:
  Motion motion_;
  std::uint8_t bur_ = 0;
  std::int64_t tick_ = 0;
};

/// Operator and hand for an exam. Throws Error when no bur of its tray fits into the target.
[[nodiscard]] SimulatedCandidate make_simulated_candidate(const ExamSetup& setup,
                                                          const std::string& skill,
                                                          std::uint64_t seed,
                                                          const OmniModel& omni);

/// Runs the exam until it is over or the input ends, then ends it. What the input still holds when
/// time is up is noted, not run. `watch` is called every 50 ticks.
void run_exam(Exam& exam, InputSource& input,
              const std::function<void(const Exam&, double progress)>& watch = {});

}  // namespace cavum::scenarios
