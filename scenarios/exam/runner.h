// Runs an exam inside the ticks: after each servo step it counts what was removed where, evaluates
// the conditions of the current step, watches time, burs and speed, and says when the exam is over.
// Same ticks, same answers: a replay runs it again and must come to the same events.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "engine/physics/servo/tick.h"
#include "engine/session/event.h"
#include "engine/tooth/adjacent.h"
#include "scenarios/file/expression.h"
#include "scenarios/file/scenario.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {

/// Everything that changes during an exam, outside the servo.
struct RunnerState {
  static constexpr std::size_t k_max_events = 256;
  std::int64_t ticks = 0;         ///< done so far
  std::int64_t step_start = 0;    ///< on the exam's clock
  std::int64_t paused_ticks = 0;  ///< of `ticks`; the exam's clock shows the others
  std::int64_t pause_start = -1;  ///< tick in which the running pause began, -1 outside
  std::int32_t pauses = 0;        ///< begun so far
  bool pause_button = false;      ///< was held in the last tick
  bool held = false;              ///< by the exam office, in the last tick
  std::int32_t holds = 0;         ///< begun so far
  std::int32_t step = 0;
  Finish finish = Finish::running;
  std::array<std::uint64_t, k_zones> removed_in_zone{};  ///< leaves
  std::uint64_t target_shares = 0;  ///< of the target, ZoneMap::target_share summed
  std::array<std::uint64_t, 256> removed_of_tissue{};  ///< leaves, by tissue id
  double depth_mm = 0.0;                               ///< deepest so far below the opening
  double peak_force_n = 0.0;
  std::int32_t last_bur = -1;
  bool over_speed = false;
  bool perforated = false;
  struct Noted {
    std::int64_t tick = 0;
    RunnerEvent event;
  };
  std::array<Noted, k_max_events> events{};
  std::uint32_t event_count = 0;
  std::uint32_t events_dropped = 0;
  /// As they are recorded, from number `first` on.
  [[nodiscard]] std::vector<TimedEvent> events_from(std::uint32_t first) const;
};

class Runner {
 public:
  /// `tray[i]` is the name of bur i of TickInput::bur. Throws Error when a condition cannot be
  /// compiled. Scenario, zones and tooth must outlive the runner.
  Runner(const Scenario& scenario, const ZoneMap& zones, const Tooth& tooth,
         const std::vector<std::string>& tray);

  /// After a servo step. Does nothing once the exam is over. Allocates nothing.
  void advance(RunnerState& state, const TickInput& input, const TickOutput& output,
               std::span<const RemovedLeaf> removed) noexcept;
  /// The candidate hands in (or is gone): the exam is over, `completed` when all steps were, else
  /// `ended`.
  void end(RunnerState& state) noexcept;

  /// True when the next tick falls into a pause, if the button is not pressed in it: the handpiece
  /// must be off.
  [[nodiscard]] static bool paused(const RunnerState& state) noexcept {
    return state.finish == Finish::running && state.pause_start >= 0;
  }
  /// True when the last tick was one of a pause by the exam office.
  [[nodiscard]] static bool held(const RunnerState& state) noexcept {
    return state.finish == Finish::running && state.held;
  }
  /// Ticks of the exam's clock until time is up, extra time included.
  [[nodiscard]] std::int64_t limit_ticks() const noexcept { return limit_ticks_; }
  /// What the candidate is asked to do now: the step, or to hand in when all are done; empty when
  /// the exam is over.
  [[nodiscard]] const std::string& instruction(const RunnerState& state) const noexcept;
  /// Live quantities by name and, after `advance`, by value.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }

 private:
  struct CompiledStep {
    Expression complete;
    std::vector<Expression> fail;  // none or one
    std::int64_t limit_ticks;
  };
  void emit(RunnerState& state, const RunnerEvent& event) const noexcept;
  void count(RunnerState& state, std::span<const RemovedLeaf> removed) const noexcept;
  void fill_values(const RunnerState& state, const TickInput& input,
                   const TickOutput& output) noexcept;
  /// Begins and ends pauses by the exam office; true when this tick is one of them. It ends a pause
  /// of the candidate's. The clock stands still only while the pedal is released.
  [[nodiscard]] bool hold(RunnerState& state, const TickInput& input) const noexcept;
  /// Begins and ends pauses; true when this tick is one of a pause.
  [[nodiscard]] bool pause(RunnerState& state, const TickInput& input,
                           const TickOutput& output) const noexcept;
  void next_step(RunnerState& state) const noexcept;
  /// The current step against this tick's values; `running`, or how it ended the exam.
  [[nodiscard]] Finish watch_step(RunnerState& state) noexcept;
  [[nodiscard]] bool all_steps_done(const RunnerState& state) const noexcept {
    return static_cast<std::size_t>(state.step) >= steps_.size();
  }
  void finish(RunnerState& state, Finish how) const noexcept;

  const Scenario& scenario_;
  const ZoneMap& zones_;
  const Octree& octree_;
  TissueSet beside_;
  std::vector<std::string> names_;
  std::vector<double> values_;
  std::vector<std::uint8_t> touched_ids_;  // tissue of names_[k_live_quantities.size() + i]
  std::vector<CompiledStep> steps_;
  std::array<std::uint8_t, 256> role_{};  // 1 aim, 2 fault, by tissue id
  std::array<bool, 256> allowed_{};       // by bur of the tray
  std::int64_t limit_ticks_ = 0, longest_pause_ticks_ = 0;
};

/// Seconds of a scenario as whole ticks (the nearest), extra time added; at least one.
[[nodiscard]] std::int64_t time_in_ticks(double seconds, double extra_percent,
                                         double extra_s = 0.0) noexcept;
/// Ticks of a scenario's time limit with what its accommodations add.
[[nodiscard]] std::int64_t exam_limit_ticks(const Scenario& scenario) noexcept;
/// The same of a step that has a limit of its own.
[[nodiscard]] std::int64_t step_limit_ticks(const Scenario& scenario,
                                            const StepSpec& step) noexcept;

}  // namespace cavum::scenarios
