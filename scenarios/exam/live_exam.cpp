#include "scenarios/exam/live_exam.h"

#include <algorithm>

#include "engine/base/error.h"

namespace cavum::scenarios {

LiveExam::LiveExam(const ExamSetup& setup, const std::string& path, ServoDevice& device,
                   Vec3 first_tip_mm, const RealTimeOptions& options)
    : LiveExam(setup, Exam::start(setup, path, first_tip_mm), device, options) {}

LiveExam::LiveExam(const ExamSetup& setup, std::unique_ptr<Exam> exam, ServoDevice& device,
                   const RealTimeOptions& options)
    : exam_(std::move(exam)),
      servo_state_(exam_->state()),
      device_(device),
      target_shares_(static_cast<double>(setup.zones.target_shares())) {
  view_.limit_ticks = exam_->limit_ticks();
  view_.session = exam_->recorder().path();
  view_.instruction = exam_->instruction();
  servo_ = std::make_unique<RealTimeServo>(exam_->model(), servo_state_, device_, stream_,
                                           exam_->last_input(), options);
  writer_ =
      std::make_unique<SessionWriter>(stream_, exam_->recorder(), exam_->model().config.tick_s,
                                      [this](const ServoTick& tick, std::span<const RemovedLeaf>) {
                                        take(tick);
                                        return false;
                                      });
}

LiveExam::~LiveExam() { finish(); }

void LiveExam::start() {
  servo_->start();
  writer_->start();
}

void LiveExam::take(const ServoTick& tick) {
  if (exam_->over()) {  // the servo learns of it a few milliseconds later
    ++report_.late_ticks;
    return;
  }
  {
    const std::lock_guard lock(tooth_mutex_);
    exam_->follow(tick.input);
  }
  if (report_.first_disagreement < 0 && state_hash(exam_->state()) != tick.state_hash) {
    report_.first_disagreement = tick.tick;
    exam_->recorder().add_event(tick.tick, ServoDisagrees{});
  }
  record_notes(tick.tick);
  if (end_asked_.load(std::memory_order_acquire) && !exam_->over()) exam_->end();
  device_.held.store(Runner::paused(exam_->runner_state()), std::memory_order_release);
  if (exam_->over()) servo_->ask_to_stop();
  show(tick);
}

void LiveExam::show(const ServoTick& tick) {
  const RunnerState& runner = exam_->runner_state();
  const std::lock_guard lock(mutex_);
  view_.ticks = runner.ticks;
  view_.paused_ticks = runner.paused_ticks;
  view_.step = runner.step;
  view_.instruction = exam_->instruction();
  view_.pauses = runner.pauses;
  view_.depth_mm = runner.depth_mm;
  view_.target_removed_percent = 100.0 * static_cast<double>(runner.target_shares) / target_shares_;
  view_.paused = Runner::paused(runner);
  view_.held = Runner::held(runner);
  view_.over = exam_->over();
  view_.input = tick.input;
  view_.output = tick.output;
  if (const auto& removed = exam_->state().removed; !removed.empty()) {
    const auto share_of = [&removed](std::uint8_t tissue) {
      const auto count =
          std::count_if(removed.begin(), removed.end(),
                        [tissue](const RemovedLeaf& leaf) { return leaf.tissue == tissue; });
      return static_cast<double>(count) / static_cast<double>(removed.size());
    };
    view_.enamel_share = share_of(k_enamel);
    view_.dentin_share = share_of(k_dentin);
  }
  view_.edit_hash = exam_->state().tooth.edit_hash();
  view_.recording_error = exam_->recording_problem();
  view_.unwritten_ticks = exam_->recorder().ticks() - exam_->recorder().ticks_on_disk();
  if (view_.session != exam_->recorder().path()) view_.session = exam_->recorder().path();
}

void LiveExam::note(Event event) {
  const std::lock_guard lock(mutex_);
  notes_.push_back(std::move(event));
}

void LiveExam::record_notes(std::int64_t tick) {
  std::vector<Event> notes;
  {
    const std::lock_guard lock(mutex_);
    notes.swap(notes_);
  }
  for (auto& event : notes) exam_->recorder().add_event(tick, std::move(event));
}

void LiveExam::look_at_tooth(const std::function<void(const Octree&)>& look) const {
  const std::lock_guard lock(tooth_mutex_);
  look(exam_->state().tooth);
}

LiveView LiveExam::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

std::string LiveExam::session() const {
  const std::lock_guard lock(mutex_);
  return view_.session;
}

const LiveReport& LiveExam::finish() {
  if (finished_) return report_;
  finished_ = true;
  servo_->ask_to_stop();
  report_.servo = servo_->join();
  report_.writer = writer_->finish();
  record_notes(std::max<std::int64_t>(0, exam_->recorder().ticks() - 1));
  return report_;
}

}  // namespace cavum::scenarios
