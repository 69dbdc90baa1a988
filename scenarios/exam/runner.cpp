#include "scenarios/exam/runner.h"

#include <algorithm>

#include "engine/base/error.h"
#include "scenarios/file/names.h"

namespace cavum::scenarios {
namespace {

/// Ticks that the exam's clock has counted: pauses stand outside.
std::int64_t clock(const RunnerState& s) noexcept { return s.ticks - s.paused_ticks; }

}  // namespace

std::vector<TimedEvent> RunnerState::events_from(std::uint32_t first) const {
  std::vector<TimedEvent> out;
  for (std::uint32_t i = first; i < event_count; ++i)
    out.push_back(
        {events[i].tick, std::visit([](const auto& e) -> Event { return e; }, events[i].event)});
  return out;
}

std::int64_t time_in_ticks(double seconds, double extra_percent, double extra_s) noexcept {
  const double ticks =
      seconds * k_ticks_per_second * (100.0 + extra_percent) / 100.0 + extra_s * k_ticks_per_second;
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(ticks + 0.5));
}

std::int64_t exam_limit_ticks(const Scenario& s) noexcept {
  return time_in_ticks(s.time_limit_s, s.accommodations.extra_time_percent,
                       s.accommodations.extra_time_s);
}

std::int64_t step_limit_ticks(const Scenario& s, const StepSpec& step) noexcept {
  const double extra_s =
      s.time_limit_s > 0 ? s.accommodations.extra_time_s / s.time_limit_s : 0.0;  // per second
  return time_in_ticks(*step.time_limit_s, s.accommodations.extra_time_percent,
                       *step.time_limit_s * extra_s);
}

Runner::Runner(const Scenario& scenario, const ZoneMap& zones, const Tooth& tooth,
               const std::vector<std::string>& tray)
    : scenario_(scenario),
      zones_(zones),
      octree_(tooth.octree),
      beside_(adjacent_tissues(tooth)),
      limit_ticks_(exam_limit_ticks(scenario)),
      longest_pause_ticks_(time_in_ticks(scenario.pauses.longest_s, 0)) {
  for (const auto& q : k_live_quantities) names_.emplace_back(q.name);
  for (const auto& t : tooth.tissues) {
    names_.push_back("touched_" + t.name);
    touched_ids_.push_back(t.id);
  }
  if (scenario.steps.empty())
    throw Error(scenario.path, msg("the scenario has no step"), msg("add [[steps]]"));
  // a tissue that this tooth does not have is simply never touched
  const auto name_all = [&](const std::string& text) {
    for (const auto& used : names_in_expression(text))
      if (std::find(names_.begin(), names_.end(), used) == names_.end() &&
          used.rfind("touched_", 0) == 0)
        names_.push_back(used);
  };
  const auto wrong = [&](const StepSpec& step, const ExpressionError& e) {
    return Error(scenario.path, msg("step '{}': {}", step.id, e.problem),
                 msg("correct the condition"));
  };
  for (const auto& step : scenario.steps) {
    try {
      name_all(step.complete_when);
      if (!step.fail_when.empty()) name_all(step.fail_when);
    } catch (const ExpressionError& e) {
      throw wrong(step, e);
    }
  }
  values_.assign(names_.size(), 0.0);  // from here on their addresses stay
  for (const auto& step : scenario.steps) {
    try {
      CompiledStep compiled{Expression(step.complete_when, names_, values_),
                            {},
                            std::numeric_limits<std::int64_t>::max()};
      if (!step.fail_when.empty()) compiled.fail.emplace_back(step.fail_when, names_, values_);
      if (step.time_limit_s) compiled.limit_ticks = step_limit_ticks(scenario, step);
      steps_.push_back(std::move(compiled));
    } catch (const ExpressionError& e) {
      throw wrong(step, e);
    }
  }
  for (const auto& t : tooth.tissues) {
    const auto among = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), t.name) != list.end();
    };
    role_[t.id] = among(scenario.perforation.aims) ? 1 : among(scenario.perforation.faults) ? 2 : 0;
  }
  for (std::size_t i = 0; i < tray.size() && i < allowed_.size(); ++i)
    allowed_[i] =
        std::find(scenario.burs.begin(), scenario.burs.end(), tray[i]) != scenario.burs.end();
}

void Runner::emit(RunnerState& state, const RunnerEvent& event) const noexcept {
  const std::size_t room =
      RunnerState::k_max_events -
      (std::holds_alternative<Finished>(event) ? 0 : 1);  // the last place is the end's
  if (state.event_count >= room) {
    ++state.events_dropped;
    return;
  }
  state.events[state.event_count++] = {state.ticks, event};
}

void Runner::finish(RunnerState& state, Finish how) const noexcept {
  state.finish = how;
  emit(state, Finished{how});
}

void Runner::count(RunnerState& state, std::span<const RemovedLeaf> removed) const noexcept {
  for (const auto& r : removed) {
    // what stands beside the tooth is counted by its tissue alone, unless it is protected
    if (!beside_[r.tissue] || zones_.zone(r.leaf()) == Zone::protected_)
      ++state.removed_in_zone[static_cast<std::size_t>(zones_.zone(r.leaf()))];
    state.target_shares += zones_.target_share(r.leaf());
    const bool first = state.removed_of_tissue[r.tissue]++ == 0;
    if (!first || role_[r.tissue] == 0) continue;
    const OfTissue opened{r.tissue, octree_.centre_mm(r.leaf())};
    emit(state, role_[r.tissue] == 1 ? RunnerEvent(AimReached{opened}) : Perforated{opened});
    state.perforated = state.perforated || role_[r.tissue] == 2;
  }
}

void Runner::fill_values(const RunnerState& s, const TickInput& input,
                         const TickOutput& output) noexcept {
  const double leaf = zones_.leaf_volume_mm3();
  const auto zone_mm3 = [&](Zone z) {
    return static_cast<double>(s.removed_in_zone[static_cast<std::size_t>(z)]) * leaf;
  };
  double removed = 0;
  for (const auto n : s.removed_in_zone) removed += static_cast<double>(n);
  const double quantity[] = {
      static_cast<double>(clock(s) + 1) * k_tick_s,
      static_cast<double>(clock(s) + 1 - s.step_start) * k_tick_s,
      100.0 * static_cast<double>(s.target_shares) / static_cast<double>(zones_.target_shares()),
      removed * leaf,
      zone_mm3(Zone::leeway_sides) + zone_mm3(Zone::leeway_bottom),
      zone_mm3(Zone::container_sides) + zone_mm3(Zone::container_bottom),
      zone_mm3(Zone::none) + zone_mm3(Zone::protected_),
      zone_mm3(Zone::protected_),
      s.depth_mm,
      output.proxy_mm.x,
      output.proxy_mm.y,
      output.proxy_mm.z,
      length(output.rendered_force_n),
      s.peak_force_n,
      input.pedal(),
      output.rpm,
      output.contact ? 1.0 : 0.0,
      output.cutting ? 1.0 : 0.0,
      static_cast<double>(input.bur),
      (input.flags & k_button_1) != 0 ? 1.0 : 0.0,
      (input.flags & k_button_2) != 0 ? 1.0 : 0.0,
      s.perforated ? 1.0 : 0.0,
  };
  static_assert(std::size(quantity) == k_live_quantities.size());
  std::copy(std::begin(quantity), std::end(quantity), values_.begin());
  for (std::size_t i = 0; i < touched_ids_.size(); ++i)
    values_[k_live_quantities.size() + i] =
        static_cast<double>(s.removed_of_tissue[touched_ids_[i]]) * leaf;
}

void Runner::next_step(RunnerState& state) const noexcept {
  ++state.step;
  state.step_start = clock(state) + 1;
  if (static_cast<std::size_t>(state.step) < steps_.size()) emit(state, StepStarted{state.step});
}

bool Runner::hold(RunnerState& state, const TickInput& input) const noexcept {
  const bool held = (input.flags & k_hold) != 0 && input.pedal_q16 == 0;
  if (held == state.held) return held;
  state.held = held;
  if (held && state.pause_start >= 0) {
    state.pause_start = -1;
    emit(state, PauseEnded{state.pauses - 1});
  }
  emit(state, held ? RunnerEvent(HoldStarted{state.holds++}) : HoldEnded{state.holds - 1});
  return held;
}

bool Runner::pause(RunnerState& state, const TickInput& input,
                   const TickOutput& output) const noexcept {
  const PauseSpec& spec = scenario_.pauses;
  if (spec.count == 0) return false;
  const bool held = (input.flags & (spec.button == 1 ? k_button_1 : k_button_2)) != 0,
             pressed = held && !state.pause_button;
  state.pause_button = held;
  if (state.pause_start >= 0) {
    if (!pressed && state.ticks - state.pause_start < longest_pause_ticks_) return true;
    state.pause_start = -1;
    emit(state, PauseEnded{state.pauses - 1});
    return false;
  }
  if (!pressed) return false;
  if (state.pauses >= spec.count || output.rpm > 0) {
    emit(state, PauseRefused{state.pauses});
    return false;
  }
  state.pause_start = state.ticks;
  emit(state, PauseStarted{state.pauses++});
  return true;
}

void Runner::advance(RunnerState& state, const TickInput& input, const TickOutput& output,
                     std::span<const RemovedLeaf> removed) noexcept {
  if (state.finish != Finish::running) return;
  if (state.ticks == 0) emit(state, StepStarted{});
  count(state, removed);
  if (hold(state, input) || pause(state, input, output)) {
    ++state.paused_ticks;
    ++state.ticks;
    return;
  }
  if (output.contact)
    state.depth_mm = std::max(state.depth_mm, zones_.below_opening_mm(output.proxy_mm));
  state.peak_force_n = std::max(state.peak_force_n, length(output.rendered_force_n));
  if (input.bur != state.last_bur && !allowed_[input.bur]) emit(state, BurNotAllowed{input.bur});
  state.last_bur = input.bur;
  const bool too_fast = output.rpm > scenario_.max_rpm * (1 + 1e-9);
  if (too_fast && !state.over_speed) emit(state, OverSpeed{});
  state.over_speed = too_fast;

  fill_values(state, input, output);
  const Finish how = all_steps_done(state) ? Finish::running : watch_step(state);
  if (how != Finish::running)
    finish(state, how);
  else if (clock(state) + 1 >= limit_ticks_) {
    emit(state, TimeUp{});
    finish(state, all_steps_done(state) ? Finish::completed : Finish::time);
  }
  ++state.ticks;
}

Finish Runner::watch_step(RunnerState& state) noexcept {
  const auto at = static_cast<std::size_t>(state.step);
  const CompiledStep& step = steps_[at];
  if (step.complete.is_true()) {
    emit(state, StepCompleted{state.step});
    next_step(state);
    return Finish::running;
  }
  const bool failed = !step.fail.empty() && step.fail[0].is_true();
  const bool late = clock(state) + 1 - state.step_start >= step.limit_ticks;
  if (!failed && !late) return Finish::running;
  emit(state, failed ? RunnerEvent(StepFailed{state.step}) : StepTimeUp{state.step});
  next_step(state);
  if (scenario_.steps[at].failure_ends_exam) return Finish::failed;
  if (!all_steps_done(state)) return Finish::running;
  return failed ? Finish::failed : Finish::time;
}

void Runner::end(RunnerState& state) noexcept {
  if (state.finish == Finish::running)
    finish(state, all_steps_done(state) ? Finish::completed : Finish::ended);
}

const std::string& Runner::instruction(const RunnerState& state) const noexcept {
  static const std::string k_over,
      k_all_done =
          "All steps are done. Go on if something is left to do, and hand in when you are ready.";
  if (state.finish != Finish::running) return k_over;
  return all_steps_done(state) ? k_all_done
                               : scenario_.steps[static_cast<std::size_t>(state.step)].instruction;
}

}  // namespace cavum::scenarios
