#include "ui/cli/solved_exam.h"

#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "grading/marking/session_input.h"
#include "grading/result/result_json.h"

namespace cavum::ui {
namespace {

/// What an instructor can do when the expert did not pass.
Fact advice_for_expert(const grading::Result& r) {
  if (r.progress.finish == Finish::time)
    return {"more_time", msg("allow more time (time_limit_s), or make the target smaller")};
  for (const auto& c : r.criteria)
    if (!c.value)
      return {"nothing_to_measure",
              {"criterion"},
              msg("take '{}' out: this cavity has nothing that it measures", c.id)};
  for (const auto& c : r.criteria)
    if (c.critical_failed)
      return {
          "critical_limit",
          {"criterion"},
          msg("move the critical limit of '{}' beyond what the expert reaches, or change the zones so that it can be kept",
              c.id)};
  if (r.verdict == grading::Verdict::review)
    return r.progress.open_last_step.empty()
               ? Fact(
                     "borderline",
                     msg("lower pass_percent, or make the borderline band narrower: the expert lies within it"))
               : Fact("last_step",
                      msg("make the last step's condition one that the expert reaches"));
  const grading::CriterionResult* worst = nullptr;
  for (const auto& c : r.criteria)
    if (worst == nullptr || c.max - c.points > worst->max - worst->points) worst = &c;
  if (worst == nullptr) return {"no_criteria", msg("give the rubric criteria")};
  return {
      "cost_most",
      {"criterion"},
      msg("begin with '{}', which cost most: set its full and zero within what the expert reaches, or allow a bur that fits the target",
          worst->id)};
}

}  // namespace

grading::Result sat_by(const scenarios::ExamSetup& setup, scenarios::SimulatedCandidate& candidate,
                       const std::string& session) {
  const auto exam = scenarios::Exam::start(setup, session, candidate.start_mm());
  scenarios::run_exam(*exam, candidate);
  exam->recorder().flush();
  grading::ExamContexts grounds(setup);
  const auto graded = grading::load_for_grading(SessionReader(session), exam->tooth_now(), grounds);
  grading::Result r = grading::grade(graded->input(), graded->rubric);
  exam->close(grading::to_json(r).dump());
  return r;
}

Solved solve_exam(const scenarios::ExamSetup& setup, std::uint64_t seed,
                  const std::string& session) {
  Solved solved;
  std::unique_ptr<scenarios::SimulatedCandidate> expert;
  try {
    expert = std::make_unique<scenarios::SimulatedCandidate>(
        scenarios::make_simulated_candidate(setup, "expert", seed, OmniModel{}));
  } catch (const Error& e) {
    solved.reasons.emplace_back("cannot_begin", std::vector{"where", "what", "what_to_do"},
                                e.message());
    solved.advice = Fact("see_check", msg("see what `cavum scenario check` warns of"));
    return solved;
  }
  solved.bur = setup.bur_names[expert->bur()];
  const grading::Result& r = solved.result.emplace(sat_by(setup, *expert, session));
  if (r.verdict == grading::Verdict::pass) return solved;
  for (const grading::Finding& reason : r.verdict_reasons)
    solved.reasons.push_back(grading::fact_of(reason));
  if (r.progress.finish == Finish::time)
    solved.reasons.emplace_back(
        "time_up", std::vector{"after"},
        msg("time was up after {}: the expert was not finished", as_s(r.motion.time_s, 1)));
  for (std::size_t i =
           static_cast<std::size_t>(r.progress.steps_completed + r.progress.steps_failed);
       i < setup.scenario.steps.size(); ++i)
    solved.reasons.emplace_back("step_open", std::vector{"step", "complete_when"},
                                msg("step {} was not completed ({})", setup.scenario.steps[i].id,
                                    setup.scenario.steps[i].complete_when));
  for (const auto& c : r.criteria)
    if (c.points < c.max || c.critical_failed)
      solved.reasons.emplace_back("criterion", std::vector{"criterion", "reason"},
                                  msg("criterion {}: {}", c.id, c.reason()));
  solved.advice = advice_for_expert(r);
  return solved;
}

}  // namespace cavum::ui
