// An exam that was broken off after 150 ticks: whole in everything that a ledger asks of it, and
// filed within milliseconds, for tests that file thousands of times and look at other things than
// physics.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "grading/marking/grade.h"
#include "grading/marking/session_input.h"
#include "grading/records/ticket.h"
#include "grading/result/result_json.h"
#include "scenarios/operators/simulated_exam.h"

namespace cavum::testing_ledger {

inline constexpr int k_short_ticks = 150;

/// The first of an expert's motion on the tooth of this exam; the same for all.
struct ShortMotion {
  Vec3 start_mm;
  std::vector<TickInput> inputs;
};
inline const ShortMotion& short_motion(const scenarios::ExamSetup& setup) {
  static const ShortMotion made = [&] {
    auto candidate = scenarios::make_simulated_candidate(setup, "expert", 7, OmniModel{});
    ShortMotion m{candidate.start_mm(), {}};
    const TickOutput rest;
    TickInput input;
    for (int i = 0; i < k_short_ticks && candidate.next(rest, input, input); ++i)
      m.inputs.push_back(input);
    return m;
  }();
  return made;
}

/// What is wrong with the station's clock while it is sat.
struct StationClock {
  std::int64_t ahead_ns = 0, set_in_the_middle_ns = 0, drift_ns_per_s = 0;
};

/// Sits it with a ticket, as a hand would, and seals it. `change` may alter what each tick reads.
inline void sit_shortly(
    const std::string& scenario, const std::string& path, const std::string& ticket,
    const StationClock& clock = {},
    const std::function<void(std::int64_t tick, TickInput& input)>& change = {}) {
  scenarios::ExamOptions options;
  options.candidate = records::parse_ticket(ticket, "", "ticket").candidate;
  options.source = {SourceKind::device, "emulated stylus", "E1"};
  options.notes.emplace_back(records::k_ticket_note, ticket);
  const auto setup = scenarios::prepare_exam(scenario, options);
  std::int64_t ticks = 0;
  const Clocks begun = read_clocks();
  const auto now = [&] {
    const std::int64_t ns = ticks * 1'000'000,
                       set = ticks > k_short_ticks / 2 ? clock.set_in_the_middle_ns : 0;
    return Clocks{begun.monotonic_ns + ns, begun.boot_ns + ns,
                  begun.utc_ns + clock.ahead_ns + ns + set + ticks * clock.drift_ns_per_s / 1000};
  };
  const auto exam = scenarios::Exam::start(*setup, path, short_motion(*setup).start_mm, now);
  for (TickInput input : short_motion(*setup).inputs) {
    if (change) change(ticks, input);
    static_cast<void>(exam->tick(input));
    ++ticks;
  }
  exam->end();
  exam->recorder().flush();
  grading::ExamContexts grounds(*setup);
  const auto graded = grading::load_for_grading(SessionReader(path), exam->tooth_now(), grounds);
  exam->close(grading::to_json(grading::grade(graded->input(), graded->rubric)).dump());
}

}  // namespace cavum::testing_ledger
