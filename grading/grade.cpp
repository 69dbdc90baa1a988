#include "grading/grade.h"

#include <algorithm>

#include "engine/base/error.h"
#include "grading/cut_surface.h"
#include "grading/motion.h"
#include "grading/perforation.h"
#include "grading/removed_map.h"
#include "grading/volumes.h"

namespace cavum {
namespace {

bool is_kind(const SessionEvent& e, ExamEventKind kind) { return e.kind == event_name(kind); }

/// Ticks that count: up to and with the one in which the exam was over.
std::int64_t counted_ticks(const GradeInput& input) {
  auto ticks = static_cast<std::int64_t>(std::min(input.inputs.size(), input.records.size()));
  for (const auto& e : input.events)
    if (is_kind(e, ExamEventKind::finished)) ticks = std::min(ticks, e.tick + 1);
  return ticks;
}

ProgressMeasures measure_progress(const GradeInput& input) {
  ProgressMeasures p;
  p.steps = static_cast<int>(input.scenario.steps.size());
  for (const auto& e : input.events) {
    p.steps_completed += is_kind(e, ExamEventKind::step_completed) ? 1 : 0;
    p.steps_failed += is_kind(e, ExamEventKind::step_failed) || is_kind(e, ExamEventKind::step_time_limit) ? 1 : 0;
    if (is_kind(e, ExamEventKind::point_not_allowed) || is_kind(e, ExamEventKind::over_speed)) {
      if (p.violations++ == 0) p.first_violation.tick = e.tick;
    }
    if (!is_kind(e, ExamEventKind::finished)) continue;
    for (const Finish f : {Finish::completed, Finish::failed, Finish::time, Finish::ended})
      if (e.detail_json.find(std::string("\"") + finish_name(f) + "\"") != std::string::npos) p.finish = finish_name(f);
  }
  return p;
}

/// The list of removed leaves and the tooth as it was left must tell the same story.
void compare_with_final_tooth(const GradeInput& input, const RemovedMap& removed, Result& result) {
  std::size_t wrong = 0;
  for (const auto& r : input.removed) {
    const IVec3 leaf = r.leaf.leaf();
    wrong += input.after.tissue(leaf) != k_air || input.before.octree.tissue(leaf) != r.leaf.tissue ? 1 : 0;
  }
  std::uint64_t before = 0, after = 0;
  for (const auto c : input.before.octree.count_leaves()) before += c;
  for (const auto c : input.after.count_leaves()) after += c;
  const bool late = result.motion.late_ticks > 0;
  if (wrong > 0 || (!late && before - after != removed.count()))
    result.notes.push_back("the list of removed leaves and the final tooth disagree: a person must look at this recording");
}

}  // namespace

Result grade(const GradeInput& input, const RubricSpec& rubric) {
  if (input.inputs.size() != input.records.size()) throw Error("grading", "as many inputs as records are needed", "use a whole session");
  Result r;
  r.scenario_id = input.scenario.id;
  r.scenario_title = input.scenario.title;
  r.tooth_name = input.before.name;
  r.tissues = input.before.tissues;
  r.leaf_mm = input.zones.leaf_mm();
  r.extra_time_percent = input.scenario.accommodations.extra_time_percent;
  const std::int64_t ticks = counted_ticks(input);
  // without motion (a cavity handed in for marking) every removed leaf counts
  const std::int64_t last_tick = input.inputs.empty() ? std::int64_t{1} << 31 : ticks - 1;
  const RemovedMap removed(input.removed, last_tick);
  r.volumes = measure_volumes(input, removed, last_tick);
  r.shape = measure_shape(input, removed, last_tick);
  r.motion = measure_motion(input, ticks);
  r.perforation = measure_perforation(input, input.inputs.empty() ? last_tick : ticks);
  r.progress = measure_progress(input);
  if (r.progress.finish != "running" && r.progress.steps_completed < r.progress.steps)
    r.notes.push_back(std::to_string(r.progress.steps - r.progress.steps_completed) + " of " + std::to_string(r.progress.steps) +
                      " steps were not completed; the verdict comes from the rubric alone");
  if (r.motion.late_ticks > 0)
    r.notes.push_back(std::to_string(r.motion.late_ticks) + " ticks were recorded after the exam was over; they do not count");
  compare_with_final_tooth(input, removed, r);
  mark(r, rubric);
  return r;
}

}  // namespace cavum
