// An exam with a hand on it: the servo runs in real time on a thread of its own, and a second
// thread takes its ticks, shows them to the runner and records them. What the second thread keeps
// is a twin: it takes every step again from the recorded input, so tooth, steps and time limit are
// exact to the tick although the servo never waits for them, and the two must agree bit for bit.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "engine/physics/servo/real_time.h"
#include "engine/session/session_writer.h"
#include "scenarios/exam/exam.h"

namespace cavum::scenarios {

/// What a window shows: a copy, never more than a few milliseconds old.
struct LiveView {
  std::int64_t ticks = 0;         ///< recorded
  std::int64_t paused_ticks = 0;  ///< of them; the exam's clock shows the others
  std::int64_t limit_ticks = 0;   ///< of the exam's clock; 0 = none
  int step = 0;                   ///< 0-based; their number when all are done
  std::string instruction;        ///< what the candidate is asked to do now
  int pauses = 0;                 ///< begun so far
  double depth_mm = 0.0;          ///< deepest so far below the opening
  double target_removed_percent = 0.0;
  bool paused = false, over = false;
  bool held = false;  ///< paused by the exam office
  TickInput input;
  TickOutput output;
  double enamel_share = 0.0,
         dentin_share = 0.0;    ///< of the leaves removed in the last tick that removed any, 0..1
  std::uint64_t edit_hash = 0;  ///< of the tooth: changes when it is cut
  std::int64_t unwritten_ticks = 0;  ///< of the recording: kept in memory so far
  std::string session;               ///< where it is recorded
  Message recording_error;  ///< empty, or why the recording cannot be written at the moment;
                            ///< nothing is lost meanwhile
};

struct LiveReport {
  RealTimeReport servo;
  WriterReport writer;
  std::int64_t late_ticks =
      0;  ///< taken by the servo after the exam was over: not recorded, not counted
  std::int64_t first_disagreement = -1;  ///< first tick at which servo and twin differ; -1 = never
};

/// Beside the events of SessionWriter it records ServoDisagrees, which makes every result of the
/// session doubtful.
class LiveExam {
 public:
  /// Begins the recording at `path`. Setup and device must outlive it. Throws Error when it cannot
  /// record.
  LiveExam(const ExamSetup& setup, const std::string& path, ServoDevice& device, Vec3 first_tip_mm,
           const RealTimeOptions& options = {});
  /// The same with one that was started or resumed already.
  LiveExam(const ExamSetup& setup, std::unique_ptr<Exam> exam, ServoDevice& device,
           const RealTimeOptions& options = {});
  /// Stops. A session that was not closed can be resumed.
  ~LiveExam();
  LiveExam(const LiveExam&) = delete;
  LiveExam& operator=(const LiveExam&) = delete;

  void start();
  /// The candidate stops: the exam is over with the next tick. Any thread.
  void ask_to_end() noexcept { end_asked_.store(true, std::memory_order_release); }
  /// Records an event that nothing in the motion shows, with the next tick, or with the last one
  /// once none follows. Any thread, before `finish`.
  void note(Event event);
  /// False once the exam is over, the device failed, or the servo was stopped.
  [[nodiscard]] bool running() const noexcept { return servo_->running(); }
  [[nodiscard]] LiveView view() const;
  /// Where it is recorded.
  [[nodiscard]] std::string session() const;
  /// Calls `look` with the twin's tooth as it is after the last tick taken. The thread that records
  /// waits meanwhile, the servo does not: whoever draws takes what changed and leaves, within a few
  /// milliseconds. Not from within `look`.
  void look_at_tooth(const std::function<void(const Octree&)>& look) const;
  /// Stops the servo and waits until every tick is taken. Then `exam` may be graded, and closed
  /// when it is over.
  const LiveReport& finish();
  /// Of the caller after `finish`, of the writing thread before.
  [[nodiscard]] Exam& exam() noexcept { return *exam_; }

 private:
  /// In a pause the pedal is released, whatever the foot does.
  class Paused final : public ServoDevice {
   public:
    explicit Paused(ServoDevice& device) : device_(device) {}
    [[nodiscard]] DeviceReading read(double elapsed_s) override {
      DeviceReading reading = device_.read(elapsed_s);
      if (held.load(std::memory_order_acquire)) reading.pedal = 0.0;
      return reading;
    }
    void show(const TickOutput& output) noexcept override { device_.show(output); }
    void send_force(Vec3 force_n) override { device_.send_force(force_n); }
    void cut_force() noexcept override { device_.cut_force(); }
    std::atomic<bool> held{false};

   private:
    ServoDevice& device_;
  };

  void take(const ServoTick& tick);
  void show(const ServoTick& tick);
  void record_notes(std::int64_t tick);

  std::unique_ptr<Exam> exam_;
  ServoState servo_state_;
  Paused device_;
  double target_shares_;
  TickStream stream_;
  std::unique_ptr<RealTimeServo> servo_;
  std::unique_ptr<SessionWriter> writer_;
  std::atomic<bool> end_asked_{false};
  LiveReport report_;
  bool finished_ = false;
  mutable std::mutex tooth_mutex_;  // of the twin's tooth, between its thread and whoever draws it
  mutable std::mutex mutex_;        // of the view
  LiveView view_;
  std::vector<Event> notes_;  // of any thread, under mutex_
};

}  // namespace cavum::scenarios
