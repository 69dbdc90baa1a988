// A candidate's exam without physics: bodies are carved out of the tooth at ticks of our choosing,
// the exam's own runner makes the events, and ticks are made up. What is handed in is marked like
// any recording.
#pragma once

#include <memory>
#include <string>

#include "grading/marking/grade.h"
#include "tests/games/task.h"

namespace cavum::games {

/// How the handpiece is held while something is done.
struct Hand {
  double force_n = 1.0;
  std::int32_t rpm = 180000;
  bool pedal = true, contact = true;
  std::uint8_t bur = 0;    ///< of the scenario's burs; one beyond them is not allowed
  double moved_mm = 0.02;  ///< of the tip, up and down, each tick
};

class Sitting {
 public:
  explicit Sitting(const Task& task);
  Sitting(const Sitting& other);
  Sitting& operator=(const Sitting&) = delete;

  /// Cuts a body in one tick and goes on for the rest of `seconds`. Does nothing once the exam is
  /// over.
  void cut(const Body& body, double seconds = 1.0, const Hand& hand = {});
  /// Passes time without cutting.
  void pass(double seconds, const Hand& hand = {0.0, 0, false, false, 0, 0.0});
  /// Releases the pedal and lifts off; ends the exam by hand where it is not over then.
  void hand_in();
  /// Ends it with the pedal pressed and the bur in the tooth.
  void walk_out();

  [[nodiscard]] grading::Result marked() const { return marked_by(task_.scenario.rubric); }
  [[nodiscard]] grading::Result marked_by(const scenarios::RubricSpec& rubric) const;
  [[nodiscard]] const Task& task() const { return task_; }
  [[nodiscard]] const std::vector<RemovedAt>& removed() const { return removed_; }
  [[nodiscard]] const Octree& after() const { return after_; }
  [[nodiscard]] bool over() const { return state_->finish != Finish::running; }

 private:
  void tick(const Hand& hand, std::span<const RemovedLeaf> leaves);

  const Task& task_;
  Octree after_;
  scenarios::Runner runner_;
  std::unique_ptr<scenarios::RunnerState> state_;
  std::vector<TickInput> inputs_;
  std::vector<TickRecord> records_;
  std::vector<RemovedAt> removed_;
};

/// What an examiner sees who counts leaves.
struct Seen {
  double target_percent = 0;  ///< of the target's leaves
  double most_percent = 0;    ///< the most that this may be: a leaf with its centre just inside may
                              ///< lie half outside, and the other way round
  bool fault_opened =
      false;  ///< a hard leaf went beside a leaf of a fault's tissue, or such a leaf itself
  double beyond_leeway_mm3 = 0.0;  ///< removed beyond target and leeway
};
[[nodiscard]] Seen seen(const Sitting& sitting);

/// 0 fail, 1 review, 2 pass.
[[nodiscard]] int rank(grading::Verdict verdict);
/// Verdict, points, each criterion's value and points, in one line.
[[nodiscard]] std::string told(const grading::Result& result);

}  // namespace cavum::games
