// A recorded exam, taken again from its inputs and shown at any moment. A thread of its own takes
// the whole exam once, as fast as the computer can, and leaves snapshots on the way; from the
// nearest of them any moment is near. Nothing in it is a film; what it shows is what the same
// physics makes of the same inputs.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "engine/session/session_reader.h"
#include "engine/session/simulation.h"
#include "scenarios/exam/exam.h"
#include "scenarios/exam/runner.h"
#include "ui/station/replay_moments.h"

namespace cavum::station {

class ReplayPlayer {
 public:
  /// Throws Error when the session is damaged, or was recorded under another version of the
  /// physics.
  explicit ReplayPlayer(const std::string& path);

  [[nodiscard]] const scenarios::ExamSetup& setup() const noexcept { return *setup_; }
  [[nodiscard]] const SessionReader& session() const noexcept { return reader_; }
  [[nodiscard]] const std::vector<ReplayMoment>& moments() const noexcept { return moments_; }
  [[nodiscard]] std::int64_t ticks() const noexcept {
    return static_cast<std::int64_t>(inputs_.size());
  }

  /// Where to go, 0..ticks(): the moment after so many ticks.
  void seek(std::int64_t tick);
  /// Goes there for `budget_s` at most; true when it is there.
  bool work(double budget_s);
  /// How far the snapshots reach, ticks: up to there every moment is at most `between()` ticks from
  /// one.
  [[nodiscard]] std::int64_t reached();
  [[nodiscard]] std::int64_t between() const noexcept { return between_; }

  /// What of a moment stands beside the tooth.
  struct Shown {
    std::int64_t tick = 0;
    scenarios::RunnerState runner;
    TickInput input;
    TickOutput output;
  };
  /// Keeps the present moment's figures: those that belong to the tooth which is drawn from now on.
  void show() { shown_ = {tick(), now_->runner, now_->input, now_->output}; }
  [[nodiscard]] const Shown& shown() const noexcept { return shown_; }

  [[nodiscard]] std::int64_t tick() const noexcept { return now_->servo.tick; }
  [[nodiscard]] const Octree& tooth() const noexcept { return now_->servo.tooth; }
  [[nodiscard]] const scenarios::RunnerState& runner() const noexcept { return now_->runner; }
  [[nodiscard]] const std::string& instruction(const scenarios::RunnerState& at) const noexcept {
    return runner_.instruction(at);
  }
  [[nodiscard]] std::uint64_t hash() const noexcept { return state_hash(now_->servo); }

 private:
  static constexpr std::int64_t k_max_snapshots = 24;
  /// Everything that changes.
  struct Moment {
    ServoState servo;
    scenarios::RunnerState runner;
    TickInput input;
    TickOutput output;
  };
  /// A runner is of one thread.
  void take_tick(Moment& moment, scenarios::Runner& runner) const;
  [[nodiscard]] scenarios::Runner make_runner() const;
  void fill(const std::stop_token& stop);
  /// The last one at or before a tick.
  [[nodiscard]] std::shared_ptr<const Moment> snapshot_before(std::int64_t tick);

  SessionReader reader_;
  std::unique_ptr<scenarios::ExamSetup> setup_;
  Simulation simulation_;
  scenarios::Runner runner_;
  std::vector<TickInput> inputs_;
  std::vector<TimedEvent> events_;
  std::vector<ReplayMoment> moments_;
  bool ended_by_hand_ = false;  // what the candidate or the supervisor ended is no input of a tick
  std::int64_t between_ = 1, goal_ = 0;
  std::unique_ptr<Moment> now_;
  Shown shown_;
  std::mutex mutex_;  // of what stands below it
  std::vector<std::shared_ptr<const Moment>>
      snapshots_;        // every `between_` ticks, as far as they reach
  std::jthread filler_;  // last: it ends before anything it uses
};

}  // namespace cavum::station
