#include "grading/marking/grade.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "grading/measures/access.h"
#include "grading/measures/adjacent.h"
#include "grading/measures/cut_surface.h"
#include "grading/measures/motion.h"
#include "grading/measures/over_pulp.h"
#include "grading/measures/removed_map.h"
#include "grading/measures/volumes.h"
#include "grading/perforation/perforation.h"
#include "grading/result/loss.h"
#include "scenarios/exam/exam.h"
#include "scenarios/exam/runner.h"
#include "scenarios/file/accommodations.h"

namespace cavum::grading {
namespace {

Number seconds(std::int64_t ticks) { return as_s(static_cast<double>(ticks) * k_tick_s, 3); }
Number at_time(std::int64_t tick) { return as_s(static_cast<double>(tick) * k_tick_s); }

/// What the events say.
struct Course {
  ProgressMeasures progress;
  std::vector<PauseMeasure> pauses;  ///< one that was running at the end ends there
  Findings steps;  ///< not completed but ended: by their own time, or by their condition
  /// Recordings that were cut off and taken up again: the exam's clock stood still meanwhile, so a
  /// reader must know how long for.
  Findings interruptions;
  Findings refused;  ///< pauses
  int pauses_refused = 0;
  std::int64_t lost_periods = 0;  ///< that the servo gave up, as the station recorded them
  LateWork late;
};

/// Takes one event after another.
class CourseReader {
 public:
  /// `ticks`: of the exam.
  CourseReader(const GradeInput& input, std::int64_t ticks) : input_(input), ticks_(ticks) {
    course_.progress.steps = static_cast<int>(input.scenario.steps.size());
    last_done_ = course_.progress.steps == 0;
    for (const auto& e : input.events) {
      tick_ = e.tick;
      std::visit(*this, e.event);
    }
    if (!last_done_ && course_.progress.finish != Finish::running)
      course_.progress.open_last_step = input.scenario.steps.back().id;
  }
  [[nodiscard]] const Course& course() const noexcept { return course_; }

  void operator()(const StepCompleted& of) {
    ++course_.progress.steps_completed;
    last_done_ = last_done_ || of.step == course_.progress.steps - 1;
  }
  void operator()(const StepFailed& of) {
    if (const scenarios::StepSpec* s = failed(of))
      course_.steps.push_back(
          finding<FindingKind::step_failed>(s->id, at_time(tick_), s->fail_when, tick_));
  }
  void operator()(const StepTimeUp& of) {
    const scenarios::StepSpec* s = failed(of);
    if (s == nullptr) return;
    course_.steps.push_back(
        s->time_limit_s
            ? finding<FindingKind::step_timed_out>(
                  s->id, at_time(tick_), seconds(scenarios::step_limit_ticks(input_.scenario, *s)),
                  tick_)
            : finding<FindingKind::step_timed_out_otherwise>(s->id, at_time(tick_), tick_));
  }
  void operator()(const AnyOf<BurNotAllowed, OverSpeed> auto&) {
    if (course_.progress.violations++ == 0) course_.progress.first_violation.tick = tick_;
  }
  void operator()(const Finished& finished) { course_.progress.finish = finished.how; }
  void operator()(const PauseStarted&) { course_.pauses.push_back({tick_, ticks_, false}); }
  void operator()(const HoldStarted&) { course_.pauses.push_back({tick_, ticks_, true}); }
  void operator()(const AnyOf<PauseEnded, HoldEnded> auto&) {
    if (!course_.pauses.empty()) course_.pauses.back().end = std::min(tick_, ticks_);
  }
  void operator()(const PauseRefused&) {
    const bool turning = tick_ >= 0 && tick_ < static_cast<std::int64_t>(input_.records.size()) &&
                         input_.records[static_cast<std::size_t>(tick_)].rpm > 0;
    ++course_.pauses_refused;
    course_.refused.push_back(
        turning ? finding<FindingKind::pause_refused_turning>(at_time(tick_), tick_)
                : finding<FindingKind::pause_refused_none_left>(at_time(tick_), tick_));
  }
  void operator()(const ServoGap& gap) {
    constexpr std::int64_t k_day = 86'400'000;  // whatever a file says
    course_.lost_periods += std::clamp<std::int64_t>(gap.periods, 0, k_day);
  }
  void operator()(const RecordingGap& gap) {
    constexpr double k_longest_s = 1e9;
    const double away_s = std::clamp(gap.utc_s(), 0.0, k_longest_s);
    course_.interruptions.push_back(
        away_s > 0 ? finding<FindingKind::interrupted_for>(at_time(tick_), as_s(away_s, 0), tick_)
                   : finding<FindingKind::interrupted>(at_time(tick_), tick_));
  }
  void operator()(const WorkAfterEnd& late) { course_.late = {late.ticks, late.pedal_ticks}; }
  void operator()(
      const AnyOf<StepStarted, TimeUp, AimReached, Perforated, RecordingMoved, Overruns,
                  StylusSilent, StylusBack, PedalLost, PedalBack, ServoStopped, ServoDisagrees,
                  ServoLateness, LockAttempt, OfficeHold, OfficeHoldReleased, Announced,
                  AnnouncementRead, TutorialStep, MeasuredForce> auto&) {}

 private:
  /// The step; null: the scenario has none of that number.
  const scenarios::StepSpec* failed(const OfStep& of) {
    ++course_.progress.steps_failed;
    const auto& steps = input_.scenario.steps;
    return static_cast<std::size_t>(of.step) < steps.size()
               ? &steps[static_cast<std::size_t>(of.step)]
               : nullptr;
  }

  const GradeInput& input_;
  std::int64_t ticks_, tick_ = 0;
  bool last_done_ = false;
  Course course_;
};

/// What granted, paused and late time means for a reader.
void note_time(const Course& course, Result& r) {
  const scenarios::Accommodations& granted = r.accommodations;
  for (const Number& extra : {as_percent(granted.extra_time_percent, k_as_needed),
                              as_s(granted.extra_time_s, k_as_needed)})
    if (extra.value > 0)
      r.notes.push_back(finding<FindingKind::extra_time>(extra, seconds(r.limit_ticks)));
  if (granted.left_handed) r.notes.push_back(finding<FindingKind::left_handed>());
  if (granted.high_contrast) r.notes.push_back(finding<FindingKind::high_contrast>());
  for (const auto& p : r.pauses) {
    const Number length = seconds(p.end - p.begin);
    r.notes.push_back(
        p.by_office ? finding<FindingKind::paused_by_office>(length, at_time(p.begin), p.begin)
                    : finding<FindingKind::paused>(length, at_time(p.begin), p.begin));
  }
  r.notes.insert(r.notes.end(), course.refused.begin(), course.refused.end());
  if (r.motion.lost_s > 0)
    r.notes.push_back(finding<FindingKind::time_lost>(as_s(r.motion.lost_s, 3)));
  r.notes.insert(r.notes.end(), course.interruptions.begin(), course.interruptions.end());
  if (r.motion.late_ticks > 0)
    r.notes.push_back(
        finding<FindingKind::late_ticks>(r.motion.late_ticks, as_mm3(r.motion.late_removed_mm3)));
  if (const Number late = seconds(r.late_work.ticks), pedal = seconds(r.late_work.pedal_ticks);
      r.late_work.ticks > 0)
    r.notes.push_back(r.progress.finish == Finish::time
                          ? finding<FindingKind::work_after_time>(late, pedal)
                          : finding<FindingKind::work_after_end>(late, pedal));
}

/// The list of removed leaves and the tooth as it was left must tell the same story.
void compare_with_final_tooth(const GradeInput& input, std::size_t removed, Result& result) {
  std::size_t wrong = 0;
  const Octree &was = input.seen_before().octree, &is = input.seen_after();
  for (const auto& r : input.all_removed()) {
    const IVec3 leaf = r.leaf.leaf();
    wrong += is.tissue(leaf) != k_air || was.tissue(leaf) != r.leaf.tissue ? 1 : 0;
  }
  std::uint64_t before = 0, after = 0;
  for (const auto c : was.count_leaves()) before += c;
  for (const auto c : is.count_leaves()) after += c;
  const bool late = result.motion.late_ticks > 0;
  if (wrong > 0 || (!late && before - after != removed))
    result.notes.push_back(finding<FindingKind::record_differs>());
}

}  // namespace

Result grade(const GradeInput& input, const scenarios::RubricSpec& rubric) {
  if (input.inputs.size() != input.records.size())
    throw Error(msg("grading"), msg("as many inputs as records are needed"),
                msg("use a whole session"));
  Result r;
  r.scenario_id = input.scenario.id;
  r.scenario_title = input.scenario.title;
  r.tooth_name = input.before.name;
  r.tissues = input.before.tissues;
  r.leaf_mm = input.zones.leaf_mm();
  r.accommodations = input.scenario.accommodations;
  r.limit_ticks = input.sat_under_ticks >= 0 ? input.sat_under_ticks
                                             : scenarios::exam_limit_ticks(input.scenario);
  if (const auto limit = scenarios::exam_limit_ticks(input.scenario); limit != r.limit_ticks)
    r.notes.push_back(finding<FindingKind::other_limit>(seconds(r.limit_ticks), seconds(limit)));
  const std::int64_t ticks =
      counted_ticks(static_cast<std::int64_t>(input.inputs.size()), input.events);
  // without motion (a cavity handed in for marking) every removed leaf counts
  const std::int64_t last_tick = input.inputs.empty() ? std::int64_t{1} << 31 : ticks - 1;
  if (ticks > 0 && !input.inputs.empty())
    r.end = {ticks - 1, input.inputs[static_cast<std::size_t>(ticks - 1)].tip_mm()};
  const RemovedMap removed(input.removed, last_tick);
  r.volumes = measure_volumes(input, removed, last_tick);
  r.shape = measure_shape(input, removed, last_tick);
  r.access = measure_access(input, removed, last_tick);
  r.over_pulp = measure_over_pulp(input, removed, last_tick);
  if (input.beside != nullptr) r.beside = measure_adjacent(input, last_tick, r.volumes);
  const CourseReader reader(input, ticks);
  const Course& course = reader.course();
  r.pauses = course.pauses;
  r.pauses_refused = course.pauses_refused;
  r.late_work = course.late;
  r.motion = measure_motion(input, ticks, r.pauses);
  r.motion.lost_s = static_cast<double>(course.lost_periods) * k_tick_s;
  for (const auto& leaf : input.all_removed())
    r.motion.late_removed_mm3 += leaf.tick > last_tick ? input.zones.leaf_volume_mm3() : 0.0;
  r.perforation = measure_perforation(input, removed, last_tick);
  if (input.not_shown != nullptr) {
    r.not_shown = *input.not_shown;
    r.perforation.force_known = false;
  }
  const scenarios::PerforationSpec& spec = input.scenario.perforation;
  for (const auto& [names, truth] :
       {std::pair(&spec.aims, &r.perforation.aim), std::pair(&spec.faults, &r.perforation.fault)})
    for (const auto& t : r.tissues)
      if (std::find(names->begin(), names->end(), t.name) != names->end())
        truth->bound_mm3 += r.volumes.tissue[t.id].bound_mm3;
  r.progress = course.progress;
  if (r.progress.finish != Finish::running && r.progress.steps_completed < r.progress.steps)
    r.notes.push_back(finding<FindingKind::steps_open>(
        r.progress.steps - r.progress.steps_completed, r.progress.steps));
  r.notes.insert(r.notes.end(), course.steps.begin(), course.steps.end());
  note_time(course, r);
  compare_with_final_tooth(input,
                           input.beside != nullptr
                               ? RemovedMap(input.all_removed(), last_tick).count()
                               : removed.count(),
                           r);
  mark(r, rubric);
  return r;
}

}  // namespace cavum::grading
