// A recorded exam, taken again from its inputs and shown at any moment: forwards as fast as the computer can, backwards from snapshots kept on the
// way. Nothing in it is a film; what it shows is what the same physics makes of the same inputs.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/session/session_reader.h"
#include "engine/session/simulation.h"
#include "scenarios/exam/exam.h"
#include "scenarios/exam/runner.h"

namespace cavum::station {

class ReplayPlayer {
 public:
  /// Throws Error when the session is damaged, or was recorded under another version of the physics.
  explicit ReplayPlayer(const std::string& path);

  [[nodiscard]] const scenarios::ExamSetup& setup() const noexcept { return *setup_; }
  [[nodiscard]] const SessionReader& session() const noexcept { return reader_; }
  [[nodiscard]] const std::vector<SessionEvent>& events() const noexcept { return events_; }
  [[nodiscard]] std::int64_t ticks() const noexcept { return static_cast<std::int64_t>(inputs_.size()); }

  /// Where to go, 0..ticks(): the moment after so many ticks.
  void seek(std::int64_t tick);
  /// Goes there for `budget_s` at most; true when it is there.
  bool work(double budget_s);

  [[nodiscard]] std::int64_t tick() const noexcept { return now_->servo.tick; }
  [[nodiscard]] const Octree& tooth() const noexcept { return now_->servo.tooth; }
  [[nodiscard]] const TickInput& input() const noexcept { return now_->input; }
  [[nodiscard]] const TickOutput& output() const noexcept { return now_->output; }
  [[nodiscard]] const scenarios::RunnerState& runner() const noexcept { return now_->runner; }
  [[nodiscard]] const std::string& instruction() const noexcept { return runner_.instruction(now_->runner); }
  [[nodiscard]] std::uint64_t hash() const noexcept { return state_hash(now_->servo); }

 private:
  static constexpr std::int64_t k_most_snapshots = 24;
  /// Everything that changes.
  struct Moment {
    ServoState servo;
    scenarios::RunnerState runner;
    TickInput input;
    TickOutput output;
  };
  void take_tick();

  SessionReader reader_;
  std::unique_ptr<scenarios::ExamSetup> setup_;
  Simulation simulation_;
  scenarios::Runner runner_;
  std::vector<TickInput> inputs_;
  std::vector<SessionEvent> events_;
  std::vector<std::unique_ptr<Moment>> snapshots_;  // every `between_` ticks; null until passed
  std::int64_t between_ = 1, goal_ = 0;
  std::unique_ptr<Moment> now_;
};

}  // namespace cavum::station
