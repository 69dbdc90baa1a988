#include "tests/games/sitting.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/tooth/octree_edit.h"
#include "scenarios/exam/exam.h"

namespace cavum::games {
namespace {

std::vector<std::string> tray_of(const Task& t) {
  std::vector<std::string> tray = t.scenario.burs;
  tray.emplace_back("flame-1.0-not-allowed");
  return tray;
}

}  // namespace

Sitting::Sitting(const Task& task)
    : task_(task),
      after_(task.tooth.octree),
      runner_(task.scenario, task.zones, task.tooth, tray_of(task)),
      state_(std::make_unique<scenarios::RunnerState>()) {}

Sitting::Sitting(const Sitting& o)
    : task_(o.task_),
      after_(o.after_),
      runner_(o.task_.scenario, o.task_.zones, o.task_.tooth, tray_of(o.task_)),
      state_(std::make_unique<scenarios::RunnerState>(*o.state_)),
      inputs_(o.inputs_),
      records_(o.records_),
      removed_(o.removed_) {}

void Sitting::tick(const Hand& hand, std::span<const RemovedLeaf> leaves) {
  const auto at = static_cast<std::int64_t>(inputs_.size());
  for (const auto& l : leaves) removed_.push_back({at, l});
  TickInput in;
  const double up = task_.middle_mm.z + (at / 50 % 2 == 0 ? static_cast<double>(at % 50)
                                                          : 50.0 - static_cast<double>(at % 50)) *
                                            hand.moved_mm;
  in.tip_nm = {static_cast<std::int32_t>(task_.middle_mm.x * 1e6),
               static_cast<std::int32_t>(task_.middle_mm.y * 1e6),
               static_cast<std::int32_t>(up * 1e6)};
  in.pedal_q16 = hand.pedal ? 65535 : 0;
  in.flags = k_stylus_fresh | k_pedal_fresh;
  in.bur = hand.bur;
  TickOutput out;
  out.rendered_force_n = {0, 0, hand.force_n};
  out.model_force_n = hand.force_n;
  out.penetration_mm = hand.contact ? 0.1 : 0.0;
  out.proxy_mm = in.tip_mm();
  out.normal = {0, 0, hand.contact ? 1.0 : 0.0};
  out.rpm = hand.rpm;
  out.contact = hand.contact;
  out.cutting = hand.contact && hand.rpm > 0;
  out.removed_count = static_cast<std::uint32_t>(leaves.size());
  inputs_.push_back(in);
  records_.push_back(make_tick_record(out));
  runner_.advance(*state_, in, out, leaves);
}

void Sitting::cut(const Body& body, double seconds, const Hand& hand) {
  if (over()) return;
  std::vector<RemovedLeaf> leaves;
  leaves.reserve(3000000);
  const Vec3 wide{4, 4, 4};
  if (!after_.carve(task_.low_mm - wide, task_.high_mm + wide, body, leaves))
    throw Error("games", msg("a carve found no room"), msg("reserve more"));
  tick(hand, leaves);
  pass(seconds - k_tick_s, hand);
}

void Sitting::pass(double seconds, const Hand& hand) {
  for (auto n = std::llround(seconds / k_tick_s); n > 0 && !over(); --n) tick(hand, {});
}

void Sitting::hand_in() {
  pass(0.3);
  runner_.end(*state_);
}

void Sitting::walk_out() { runner_.end(*state_); }

grading::Result Sitting::marked_by(const scenarios::RubricSpec& rubric) const {
  const std::vector<TimedEvent> events = state_->events_from(0);
  if (!task_.apart)
    return grading::grade(
        {task_.scenario, task_.tooth, task_.zones, after_, inputs_, records_, removed_, events},
        rubric);
  const grading::WorkApart own = take_apart(*task_.apart, after_, removed_);
  const grading::AdjacentInput beside{*task_.apart, task_.tooth, after_, removed_};
  grading::GradeInput input{task_.scenario, task_.apart->own, task_.zones, own.after,
                            inputs_,        records_,         own.removed, events};
  input.beside = &beside;
  return grading::grade(input, rubric);
}

namespace {

/// Leaves of the target, of which so many lie at its border, and leaves just outside.
struct Counted {
  double inside = 0, inner_rim = 0, outer_rim = 0;
  void count(const Task& t, IVec3 leaf) {
    const bool in = t.zones.zone(leaf) == scenarios::Zone::target;
    const bool rim = std::any_of(
        std::begin(scenarios::k_six_neighbours), std::end(scenarios::k_six_neighbours),
        [&](IVec3 step) { return (t.zones.zone(leaf + step) == scenarios::Zone::target) != in; });
    inside += in ? 1 : 0;
    inner_rim += in && rim ? 1 : 0;
    outer_rim += !in && rim ? 1 : 0;
  }
  /// With so much of each leaf at the border lying in the target.
  [[nodiscard]] double sum(double inner, double outer) const {
    return inside - inner_rim + inner * inner_rim + outer * outer_rim;
  }
};

}  // namespace

Seen seen(const Sitting& s) {
  const Task& t = s.task();
  const Octree& before = t.tooth.octree;
  std::array<bool, 256> fault{};
  for (const auto& tissue : t.tooth.tissues)
    fault[tissue.id] = std::count(t.scenario.perforation.faults.begin(),
                                  t.scenario.perforation.faults.end(), tissue.name) > 0;
  Seen seen;
  Counted all, gone;
  t.zones.for_each_leaf([&](IVec3 leaf, scenarios::Zone) {
    if (before.tissue(leaf) != k_air) all.count(t, leaf);
  });
  std::size_t beyond = 0;
  for (const auto& r : s.removed()) {
    const IVec3 l = r.leaf.leaf();
    const scenarios::Zone z = t.zones.zone(l);
    gone.count(t, l);
    if (z != scenarios::Zone::target && z != scenarios::Zone::leeway_sides &&
        z != scenarios::Zone::leeway_bottom)
      ++beyond;
    seen.fault_opened = seen.fault_opened || fault[r.leaf.tissue];
    if (before.is_solid(r.leaf.tissue))
      for (const IVec3 n : scenarios::k_six_neighbours)
        seen.fault_opened = seen.fault_opened || fault[before.tissue(l + n)];
  }
  seen.target_percent = 100.0 * gone.inside / all.inside;
  for (const auto& [inner, outer] : {std::pair(1.0, 0.0), {0.5, 0.0}, {1.0, 0.5}, {0.5, 0.5}})
    seen.most_percent =
        std::max(seen.most_percent, 100.0 * gone.sum(inner, outer) / all.sum(inner, outer));
  seen.beyond_leeway_mm3 = static_cast<double>(beyond) * t.zones.leaf_volume_mm3();
  return seen;
}

int rank(grading::Verdict v) {
  return v == grading::Verdict::pass ? 2 : v == grading::Verdict::review ? 1 : 0;
}

std::string told(const grading::Result& r) {
  std::string text = fmt::format("{} {:.3f}/{:.0f} ({})", grading::verdict_name(r.verdict),
                                 r.points, r.max_points, finish_name(r.progress.finish));
  for (const auto& c : r.criteria) {
    text += c.value ? fmt::format("; {} {:.4f} ± {:.4f}", c.id, *c.value, c.bound)
                    : fmt::format("; {} none", c.id);
    text += fmt::format(" -> {:.3f}/{:.0f}{}", c.points, c.max, c.critical_failed ? "!" : "");
    if (c.work_share < 1) text += fmt::format(" x{:.3f}", c.work_share);
  }
  return text;
}

}  // namespace cavum::games
