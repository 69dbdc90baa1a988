#include "grading/grade.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "grading/breakthrough/perforation.h"
#include "grading/measures/access.h"
#include "grading/measures/beside.h"
#include "grading/measures/cut_surface.h"
#include "grading/measures/motion.h"
#include "grading/measures/over_pulp.h"
#include "grading/measures/removed_map.h"
#include "grading/measures/volumes.h"
#include "grading/result/loss.h"
#include "scenarios/exam/exam.h"
#include "scenarios/exam/runner.h"
#include "scenarios/file/accommodations.h"

namespace cavum::grading {
namespace {

bool is_kind(const SessionEvent& e, scenarios::ExamEventKind kind) { return e.kind == scenarios::event_name(kind); }

ProgressMeasures measure_progress(const GradeInput& input) {
  ProgressMeasures p;
  const std::string last = input.scenario.steps.empty() ? std::string() : input.scenario.steps.back().id;
  bool last_done = last.empty();
  p.steps = static_cast<int>(input.scenario.steps.size());
  for (const auto& e : input.events) {
    p.steps_completed += is_kind(e, scenarios::ExamEventKind::step_completed) ? 1 : 0;
    last_done = last_done || (is_kind(e, scenarios::ExamEventKind::step_completed) && text_in(parse_json_or_null(e.detail_json), "step") == last);
    p.steps_failed += is_kind(e, scenarios::ExamEventKind::step_failed) || is_kind(e, scenarios::ExamEventKind::step_time_limit) ? 1 : 0;
    if (is_kind(e, scenarios::ExamEventKind::point_not_allowed) || is_kind(e, scenarios::ExamEventKind::over_speed)) {
      if (p.violations++ == 0) p.first_violation.tick = e.tick;
    }
    if (!is_kind(e, scenarios::ExamEventKind::finished)) continue;
    for (const scenarios::Finish f : {scenarios::Finish::completed, scenarios::Finish::failed, scenarios::Finish::time, scenarios::Finish::ended})
      if (e.detail_json.find(fmt::format("\"{}\"", scenarios::finish_name(f))) != std::string::npos) p.finish = scenarios::finish_name(f);
  }
  if (!last_done && p.finish != "running") p.open_last_step = last;
  return p;
}

/// Pauses up to tick `ticks`; one that was running at the end ends there.
std::vector<PauseMeasure> find_pauses(const GradeInput& input, std::int64_t ticks) {
  std::vector<PauseMeasure> list;
  for (const auto& e : input.events) {
    const bool held = is_kind(e, scenarios::ExamEventKind::hold_started);
    if (held || is_kind(e, scenarios::ExamEventKind::pause_started)) list.push_back({e.tick, ticks, held});
    if ((is_kind(e, scenarios::ExamEventKind::pause_ended) || is_kind(e, scenarios::ExamEventKind::hold_ended)) && !list.empty())
      list.back().end = std::min(e.tick, ticks);
  }
  return list;
}

LateWork find_late_work(const GradeInput& input) {
  for (const auto& e : input.events) {
    if (e.kind != scenarios::k_late_work) continue;
    const auto detail = parse_json_or_null(e.detail_json);
    if (detail.is_object()) return {whole_in(detail, "ticks"), whole_in(detail, "pedal_ticks")};
  }
  return {};
}

std::string seconds(std::int64_t ticks) { return fixed(static_cast<double>(ticks) * k_tick_s, 3) + " s"; }

/// Steps that were not completed but ended: by their own time, or by their condition.
void note_steps(const GradeInput& input, Result& r) {
  std::size_t step = 0;
  for (const auto& e : input.events) {
    const bool late = is_kind(e, scenarios::ExamEventKind::step_time_limit), failed = is_kind(e, scenarios::ExamEventKind::step_failed);
    if ((late || failed) && step < input.scenario.steps.size()) {
      const scenarios::StepSpec& s = input.scenario.steps[step];
      const std::string at = " at " + when({e.tick, {}});
      if (failed)
        r.notes.push_back(fmt::format("step '{}' failed{}: {}", s.id, at, s.fail_when));
      else
        r.notes.push_back(fmt::format("step '{}' ran out of its time{}{}", s.id, at,
                                      s.time_limit_s ? ": its limit was " + seconds(scenarios::step_limit_ticks(input.scenario, s)) : ""));
    }
    step += late || failed || is_kind(e, scenarios::ExamEventKind::step_completed) ? 1 : 0;
  }
}

/// Periods that the servo gave up, as the station recorded them.
double lost_s(std::span<const SessionEvent> events) {
  constexpr std::int64_t k_day = 86'400'000;  // whatever a file says
  std::int64_t periods = 0;
  for (const auto& e : events)
    if (e.kind == k_servo_gap_event) periods += std::clamp<std::int64_t>(whole_in(parse_json_or_null(e.detail_json), "periods"), 0, k_day);
  return static_cast<double>(periods) * k_tick_s;
}

/// Recordings that were cut off and taken up again: the exam's clock stood still meanwhile, so a reader must know how long for.
void note_interruptions(const GradeInput& input, Result& r) {
  constexpr double k_longest_s = 1e9;  // whatever a file says
  for (const auto& e : input.events) {
    if (e.kind != "gap") continue;
    const auto detail = parse_json_or_null(e.detail_json);
    const auto gap = detail.is_object() ? detail.find("gap_utc_s") : detail.end();
    const double away_s = gap != detail.end() && gap->is_number() ? std::clamp(gap->get<double>(), 0.0, k_longest_s) : 0.0;
    r.notes.push_back(fmt::format("the recording was interrupted at {} and taken up again{}; the exam's clock stood still meanwhile",
                                  when({e.tick, {}}),
                                  away_s > 0 ? fmt::format(" after {} s by the computer's clock", fixed(away_s, 0)) : std::string()));
  }
}

/// What granted, paused and late time means for a reader.
void note_time(const GradeInput& input, Result& r) {
  std::string refused;
  for (const auto& e : input.events) {
    if (!is_kind(e, scenarios::ExamEventKind::pause_refused)) continue;
    const bool turned =
        e.tick >= 0 && e.tick < static_cast<std::int64_t>(input.records.size()) && input.records[static_cast<std::size_t>(e.tick)].rpm > 0;
    refused += fmt::format("{}tick {}{}", refused.empty() ? "" : ", ", e.tick, turned ? ": the handpiece turned" : ": none was left");
  }
  if (const auto text = scenarios::accommodations_text(r.accommodations); !text.empty())
    r.notes.push_back(fmt::format("accommodations: {}; the limit was {}", text, seconds(r.limit_ticks)));
  if (!r.pauses.empty()) {
    std::string list;
    std::int64_t sum = 0;
    for (const auto& p : r.pauses) {
      list += fmt::format("{}{} from tick {}{}", list.empty() ? "" : ", ", seconds(p.end - p.begin), p.begin, p.by_office ? " by the office" : "");
      sum += p.end - p.begin;
    }
    r.notes.push_back(fmt::format("pauses: {}, {} in all, which do not count ({})", r.pauses.size(), seconds(sum), list));
  }
  if (r.pauses_refused > 0)
    r.notes.push_back(fmt::format("{}{} asked for and not given ({})", r.pauses_refused, r.pauses_refused == 1 ? " pause" : " pauses", refused));
  if (r.motion.lost_s > 0)
    r.notes.push_back(fixed(r.motion.lost_s, 3) +
                      " s were lost while the station's program stood still: the exam's clock does not show them, and the " + "candidate had them");
  note_interruptions(input, r);
  if (r.motion.late_ticks > 0)
    r.notes.push_back(fmt::format("{} ticks were recorded after the exam was over, {} mm3 removed in them; they do not count", r.motion.late_ticks,
                                  fixed(r.motion.late_removed_mm3, 2)));
  if (r.late_work.ticks > 0)
    r.notes.push_back(
        fmt::format("the candidate went on for {}{}, with the pedal pressed for {}; the tooth stayed as it was, and nothing of it counts",
                    seconds(r.late_work.ticks), r.progress.finish == "time" ? " after time was up" : " after the exam was over",
                    seconds(r.late_work.pedal_ticks)));
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
    result.notes.push_back("the list of removed leaves and the final tooth disagree: a person must look at this recording");
}

}  // namespace

Result grade(const GradeInput& input, const scenarios::RubricSpec& rubric) {
  if (input.inputs.size() != input.records.size()) throw Error("grading", "as many inputs as records are needed", "use a whole session");
  Result r;
  r.scenario_id = input.scenario.id;
  r.scenario_title = input.scenario.title;
  r.tooth_name = input.before.name;
  r.tissues = input.before.tissues;
  r.leaf_mm = input.zones.leaf_mm();
  r.accommodations = input.scenario.accommodations;
  r.limit_ticks = input.sat_under_ticks >= 0 ? input.sat_under_ticks : scenarios::exam_limit_ticks(input.scenario);
  if (const auto limit = scenarios::exam_limit_ticks(input.scenario); limit != r.limit_ticks)
    r.notes.push_back(fmt::format("the exam ran under a limit of {}; the scenario it is marked by has {}, which was not applied",
                                  seconds(r.limit_ticks), seconds(limit)));
  const std::int64_t ticks = counted_ticks(static_cast<std::int64_t>(input.inputs.size()), input.events);
  // without motion (a cavity handed in for marking) every removed leaf counts
  const std::int64_t last_tick = input.inputs.empty() ? std::int64_t{1} << 31 : ticks - 1;
  if (ticks > 0 && !input.inputs.empty()) r.end = {ticks - 1, input.inputs[static_cast<std::size_t>(ticks - 1)].tip_mm()};
  const RemovedMap removed(input.removed, last_tick);
  r.volumes = measure_volumes(input, removed, last_tick);
  r.shape = measure_shape(input, removed, last_tick);
  r.access = measure_access(input, removed, last_tick);
  r.over_pulp = measure_over_pulp(input, removed, last_tick);
  if (input.beside != nullptr) r.beside = measure_beside(input, last_tick, r.volumes);
  r.pauses = find_pauses(input, ticks);
  for (const auto& e : input.events) r.pauses_refused += is_kind(e, scenarios::ExamEventKind::pause_refused) ? 1 : 0;
  r.late_work = find_late_work(input);
  r.motion = measure_motion(input, ticks, r.pauses);
  r.motion.lost_s = lost_s(input.events);
  for (const auto& leaf : input.all_removed()) r.motion.late_removed_mm3 += leaf.tick > last_tick ? input.zones.leaf_volume_mm3() : 0.0;
  r.perforation = measure_perforation(input, removed, last_tick);
  if (input.not_shown != nullptr) {
    r.not_shown = *input.not_shown;
    r.perforation.force_known = false;
  }
  const scenarios::PerforationSpec& spec = input.scenario.perforation;
  for (const auto& [names, truth] : {std::pair(&spec.aims, &r.perforation.aim), std::pair(&spec.faults, &r.perforation.fault)})
    for (const auto& t : r.tissues)
      if (std::find(names->begin(), names->end(), t.name) != names->end()) truth->bound_mm3 += r.volumes.tissue[t.id].bound_mm3;
  r.progress = measure_progress(input);
  if (input.landmarks_anew)
    r.notes.emplace_back(
        "the recording is of before exams kept the landmarks that their zones follow: this version found them anew, and the zones may lie elsewhere "
        "than "
        "in the exam; a person must look at it, and the sealed result is the exam's");
  if (r.progress.finish != "running" && r.progress.steps_completed < r.progress.steps)
    r.notes.push_back(fmt::format("steps not completed: {} of {}", r.progress.steps - r.progress.steps_completed, r.progress.steps));
  note_steps(input, r);
  note_time(input, r);
  compare_with_final_tooth(input, input.beside != nullptr ? RemovedMap(input.all_removed(), last_tick).count() : removed.count(), r);
  mark(r, rubric);
  return r;
}

}  // namespace cavum::grading
