#include "scenarios/operators/simulated_exam.h"

#include <fmt/core.h>

#include <algorithm>

namespace cavum::scenarios {

SimulatedCandidate::SimulatedCandidate(Candidate candidate, const OmniModel& omni)
    : candidate_(std::move(candidate)),
      omni_(omni),
      state_(make_omni_state(candidate_.hands.start_mm())) {}

bool SimulatedCandidate::next(const TickOutput& last, const TickInput& previous,
                              TickInput& input) noexcept {
  const Intent intent = candidate_.hands.act(last, k_tick_s);
  constexpr std::int64_t k_rest_ticks = 1500;  // a finished candidate holds still for a moment:
                                               // conditions of the last step can come true
  if (intent.done && ++rested_ > k_rest_ticks) return false;
  const Vec3 tip = advance_omni(omni_, candidate_.hands.skill().hand, state_, last.rendered_force_n,
                                intent.tip_mm, k_tick_s);
  input = make_tick_input({tip, candidate_.hands.rotation()}, intent.pedal,
                          k_stylus_fresh | k_pedal_fresh, intent.bur, previous);
  return true;
}

PlayedMotion::PlayedMotion(Motion motion, const std::vector<std::string>& bur_names,
                           const std::string& where)
    : motion_(std::move(motion)) {
  if (!motion_.bur.empty()) {
    const auto found = std::find(bur_names.begin(), bur_names.end(), motion_.bur);
    if (found == bur_names.end())
      throw Error(where, msg("names the bur '{}', which this scenario does not allow", motion_.bur),
                  msg("use one of its burs"));
    bur_ = static_cast<std::uint8_t>(found - bur_names.begin());
  }
}

bool PlayedMotion::next(const TickOutput&, const TickInput& previous, TickInput& input) noexcept {
  const double t_s = static_cast<double>(tick_) * k_tick_s;
  if (t_s > motion_.duration_s()) return false;
  ++tick_;
  const MotionSample s = motion_.at(t_s);
  const auto flags =
      static_cast<std::uint16_t>(k_stylus_fresh | k_pedal_fresh | (s.button_1 ? k_button_1 : 0) |
                                 (s.button_2 ? k_button_2 : 0));
  const auto bur = s.bur >= 0 ? static_cast<std::uint8_t>(std::min(s.bur, 255)) : bur_;
  input = make_tick_input(s.pose, s.pedal, flags, bur, previous);
  return true;
}

double PlayedMotion::progress() const noexcept {
  const double d = motion_.duration_s();
  return d > 0 ? std::min(1.0, static_cast<double>(tick_) * k_tick_s / d) : 1.0;
}

InputSource::Rest PlayedMotion::rest() noexcept {
  Rest rest;
  TickInput input;
  while (next({}, {}, input)) {
    ++rest.ticks;
    rest.pedal_ticks += input.pedal_q16 > 0 ? 1 : 0;
  }
  return rest;
}

SimulatedCandidate make_simulated_candidate(const ExamSetup& setup, const std::string& skill,
                                            std::uint64_t seed, const OmniModel& omni) {
  std::vector<ContactTool> tray;
  for (const auto& p : setup.burs) tray.push_back(make_contact_tool(p));
  return {make_candidate(skill, setup.scenario, setup.zones, setup.tooth, tray, seed), omni};
}

void run_exam(Exam& exam, InputSource& source,
              const std::function<void(const Exam&, double)>& watch) {
  constexpr std::int64_t k_watch_ticks = 50;
  TickInput input;
  while (!exam.over() && source.next(exam.last(), exam.last_input(), input)) {
    exam.tick(input);
    if (watch && exam.state().tick % k_watch_ticks == 0) watch(exam, source.progress());
  }
  if (!exam.over()) exam.end();
  if (const auto rest = source.rest(); rest.ticks > 0) exam.note_late(rest.ticks, rest.pedal_ticks);
}

}  // namespace cavum::scenarios
