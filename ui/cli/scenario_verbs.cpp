// `cavum scenario check | show | solve | schema`: authoring help.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/message_json.h"
#include "engine/base/scratch_folder.h"
#include "engine/tooth/tooth.h"
#include "grading/marking/session_input.h"
#include "grading/result/result_json.h"
#include "grading/trial/trial_output.h"
#include "scenarios/exam/exam.h"
#include "scenarios/file/parse.h"
#include "scenarios/operators/simulated_exam.h"
#include "scenarios/review/check.h"
#include "scenarios/review/picture.h"
#include "scenarios/review/scenario_schema.h"
#include "scenarios/zones/zone_map.h"
#include "ui/cli/scenario_new.h"
#include "ui/cli/solved_exam.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"
#include "ui/parts/scenario_words.h"

namespace cavum::ui {
namespace {

struct ScenarioArguments {
  std::string scenario, tooth, out, model = "consistent";
  std::uint64_t seed = 1;
  bool json = false, careless = false, trial = false, no_trial = false;
};

int check(const ScenarioArguments& o) {
  scenarios::CheckedScenario checked =
      scenarios::check_whole(read_text_file(o.scenario), o.scenario, o.tooth);
  if (checked.laid && !o.no_trial) {
    const grading::Trial trial = grading::run_trial(checked.laid->scenario, checked.laid->tooth,
                                                    checked.laid->zones, grading::Look::screened);
    checked.problems.insert(checked.problems.end(), trial.problems.begin(), trial.problems.end());
    scenarios::sort_problems(checked.problems);
  }
  if (o.json) {
    nlohmann::ordered_json j{{"scenario", o.scenario},
                             {"sound", checked.sound()},
                             {"problems", nlohmann::ordered_json::array()}};
    for (const auto& p : checked.problems)
      j["problems"].push_back({{"severity", p.warning ? "warning" : "error"},
                               {"kind", name_in(p.mistake)},
                               {"where", p.where},
                               {"line", p.where.line},
                               {"column", p.where.column},
                               {"values", values_json(p.what)},
                               {"what", p.what},
                               {"what_to_do", p.what_to_do}});
    j["expert_s"] = checked.expert.time_s
                        ? nlohmann::ordered_json(std::round(*checked.expert.time_s))
                        : nlohmann::ordered_json(nullptr);
    if (checked.expert.time_s) j["expert_reach_percent"] = std::round(100 * checked.expert.reach);
    print_json(j);
  } else {
    for (const auto& p : checked.problems) say(p.message());
    if (checked.sound()) {
      const auto n = static_cast<std::int64_t>(checked.problems.size());
      say(n == 0 ? msg("{}: sound", o.scenario)
                 : msgn("{}: no mistakes, {} warning", "{}: no mistakes, {} warnings", n,
                        o.scenario, n));
      if (checked.expert.time_s)
        say(msg("the built-in expert needs about {} and reaches {} of the cavity",
                as_s(*checked.expert.time_s, 0), as_percent(100 * checked.expert.reach, 0)));
      if (n > 0) say(msg("whether it can be passed: {}", "cavum scenario solve " + o.scenario));
    }
  }
  return checked.sound() ? 0 : 1;
}

/// Volumes of the zones in the tooth, each with half a leaf over its border; the target's by parts
/// of leaves, as it is graded.
std::array<grading::BoundedVolume, scenarios::k_zones> zone_volumes(
    const Tooth& tooth, const scenarios::ZoneMap& zones) {
  std::array<grading::BoundedVolume, scenarios::k_zones> volumes{};
  const double leaf_mm3 = zones.leaf_volume_mm3();
  const IVec3 size = tooth.octree.size();
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const IVec3 leaf{x, y, z};
        const scenarios::Zone own = zones.zone(leaf);
        if (own == scenarios::Zone::none) continue;
        grading::BoundedVolume& v = volumes[static_cast<std::size_t>(own)];
        v.mm3 += leaf_mm3;
        for (const IVec3 step : scenarios::k_six_neighbours)
          if (zones.zone(leaf + step) != own) {
            v.bound_mm3 += 0.5 * leaf_mm3;
            break;
          }
      }
  volumes[static_cast<std::size_t>(scenarios::Zone::target)] = {
      static_cast<double>(zones.target_shares()) /
          static_cast<double>(scenarios::ZoneMap::k_share_units) * leaf_mm3,
      0.5 * static_cast<double>(zones.target_border_leaves()) * leaf_mm3};
  return volumes;
}

int show(const ScenarioArguments& o) {
  if (!o.out.ends_with(".svg"))
    throw Error(Name{o.out}, msg("the zones are drawn as SVG only"),
                msg("use a name ending in .svg"));
  require_writable(o.out);
  const scenarios::Scenario s = scenarios::load_scenario(o.scenario);
  const Tooth tooth = load_tooth_file(o.tooth.empty() ? scenarios::find_tooth_file(s) : o.tooth);
  const scenarios::ZoneMap zones = scenarios::build_zones(s, tooth);
  show_texts_of(s);
  write_text_file(o.out, scenarios::scenario_sheet_svg(s, tooth, zones, tr));
  const auto volumes = zone_volumes(tooth, zones);
  if (o.json) {
    nlohmann::ordered_json j{{"out", o.out},
                             {"tooth", tooth.name},
                             {"opening_z_mm", zones.opening_z_mm()},
                             {"zones_mm3", nlohmann::ordered_json::object()},
                             {"bounds_mm3", nlohmann::ordered_json::object()}};
    for (std::size_t z = 1; z < scenarios::k_zones; ++z) {
      j["zones_mm3"][scenarios::zone_name(static_cast<scenarios::Zone>(z))] =
          grading::rounded(volumes[z].mm3);
      j["bounds_mm3"][scenarios::zone_name(static_cast<scenarios::Zone>(z))] =
          grading::rounded(volumes[z].bound_mm3);
    }
    print_json(j);
    return 0;
  }
  for (std::size_t z = 1; z < scenarios::k_zones; ++z)
    say(msg("{}: {}", Term{scenarios::zone_name(static_cast<scenarios::Zone>(z))},
            as_mm3(volumes[z].mm3, 2, volumes[z].bound_mm3)));
  say(msg("drawn: {}", o.out));
  return 0;
}

/// The careless candidate's exam: whether it was failed, and by the criterion that the scenario
/// names.
struct Caught {
  grading::Result result;
  grading::CriterionResult criterion;
  bool as_named = false;
  Fact advice;  ///< what to change when it is not caught
};

/// Why the careless candidate got away, and what to do about it.
Fact advice_for(const Caught& c) {
  const grading::CriterionResult& named = c.criterion;
  const bool lost_all = named.critical_failed || named.points <= 0;
  if (c.result.progress.finish == Finish::time)
    return {
        "more_time",
        msg("time ran out before the mistake told: allow more time, or make the mistake in [careless] quicker to see")};
  if (lost_all && c.result.verdict == grading::Verdict::review)
    return {
        "borderline",
        {"criterion"},
        msg("a person would have to decide: make '{}' critical, or raise the pass mark by more than the borderline band",
            named.id)};
  if (lost_all)
    return {
        "compensated",
        {"criterion"},
        msg("'{}' gives no points, but the others make up for it: set its critical_above or critical_below, or make the rubric non-compensatory",
            named.id)};
  const Message value = !named.value         ? msg("no value")
                        : named.unit.empty() ? msg("{}", as_number(*named.value, 2))
                                             : msg("{} {}", as_number(*named.value, 2), named.unit);
  return {
      "too_mild",
      {"criterion", "points", "max", "value"},
      msg("'{}' still gives {} of {} points for {}: make the mistake in [careless] larger, or the criterion stricter so that it gives none for "
          "that, or "
          "let fails_by name another",
          named.id, as_points(named.points), as_points(named.max), value)};
}

Caught catch_careless(const ScenarioArguments& o, const scenarios::ExamSetup& setup,
                      const std::string& session) {
  scenarios::SimulatedCandidate candidate =
      scenarios::make_simulated_candidate(setup, "careless", o.seed, OmniModel{});
  Caught c{sat_by(setup, candidate, session), {}, false, {}};
  for (const auto& one : c.result.criteria)
    if (one.id == setup.scenario.careless.fails_by) c.criterion = one;
  // running out of time is another reason than the one the task is there for
  c.as_named = c.result.verdict == grading::Verdict::fail &&
               c.result.progress.finish != Finish::time &&
               (c.criterion.critical_failed || c.criterion.points <= 0);
  if (!c.as_named) c.advice = advice_for(c);
  return c;
}

nlohmann::ordered_json to_json(const Caught& c) {
  const auto result = grading::with_words(grading::to_json(c.result));
  nlohmann::ordered_json j{{"fails_by", c.criterion.id},
                           {"caught", c.as_named},
                           {"reason", english_text(c.criterion.reason())},
                           {"what_to_do", c.advice.empty() ? nlohmann::ordered_json(nullptr)
                                                           : nlohmann::ordered_json(c.advice)}};
  for (const char* key : {"verdict", "score", "time_s", "finish", "criteria"}) j[key] = result[key];
  return j;
}

Lines to_text(const Caught& c) {
  Lines out;
  const Number points = as_points(c.result.points), most = as_points(c.result.max_points);
  const Term verdict = grading::word_of(c.result.verdict);
  out.add(c.as_named ? msg("careless: failed by {} ({}); {} of {} points, {}", c.criterion.id,
                           c.criterion.reason(), points, most, verdict)
                     : msg("careless: NOT failed by {} ({}); {} of {} points, {}", c.criterion.id,
                           c.criterion.reason(), points, most, verdict));
  if (c.as_named) return out;
  for (const auto& reason : c.result.verdict_reasons) out.add(msg("because: {}", reason.message()));
  out.add(msg("what to do: {}", c.advice.what()));
  return out;
}

void say_trial(const grading::Trial& trial) {
  say(msg("faulty preparations, marked by this rubric ({} pieces in {}):", trial.rows.size(),
          as_s(trial.wall_s, 1)));
  say(grading::trial_text(trial));
  for (const auto& p : trial.problems) say(p.message());
}

int solve(const ScenarioArguments& o) {
  if (!o.out.empty()) require_writable(o.out);
  scenarios::ExamOptions options;
  options.candidate = "built-in expert";
  options.tooth_file = o.tooth;
  options.force_model = o.model;
  options.source = {SourceKind::simulated_operator, "expert"};
  options.notes = {{"operator", "expert"}, {"operator_seed", std::to_string(o.seed)}};
  const auto setup = scenarios::prepare_exam(o.scenario, options);
  if (o.careless && setup->scenario.careless.fails_by.empty())
    throw Error(Name{o.scenario}, msg("the scenario says nothing of a careless candidate"),
                msg("add [careless] with the mistake it is to catch, or leave out --careless"));
  const ScratchFolder scratch;
  const Solved solved =
      solve_exam(*setup, o.seed, o.out.empty() ? scratch.file("expert.cavum") : o.out);
  const bool passed = solved.result && solved.result->verdict == grading::Verdict::pass;
  std::optional<Caught> careless;
  if (o.careless && solved.result)
    careless = catch_careless(o, *setup, scratch.file("careless.cavum"));
  std::optional<grading::Trial> trial;
  if (o.trial)
    trial =
        grading::run_trial(setup->scenario, setup->tooth, setup->zones, grading::Look::screened);
  const bool wrong_passes =
      trial && std::any_of(trial->problems.begin(), trial->problems.end(),
                           [](const scenarios::Problem& p) { return !p.warning; });
  const int answer =
      passed && (!o.careless || (careless && careless->as_named)) && !wrong_passes ? 0 : 1;
  const double limit_s =
      static_cast<double>(scenarios::exam_limit_ticks(setup->scenario)) * k_tick_s;
  if (o.json) {
    nlohmann::ordered_json j{{"scenario", o.scenario},
                             {"tooth", setup->tooth.name},
                             {"passed", passed},
                             {"time_limit_s", limit_s}};
    if (solved.result) {
      j["bur"] = solved.bur;
      auto result = grading::with_words(grading::to_json(*solved.result));
      for (const char* key : {"verdict", "score", "time_s", "finish", "steps", "criteria"})
        j[key] = result[key];
    }
    j["reasons"] = solved.reasons;
    j["what_to_do"] = solved.advice.empty() ? nlohmann::ordered_json(nullptr)
                                            : nlohmann::ordered_json(solved.advice);
    if (o.careless) j["careless"] = careless ? to_json(*careless) : nlohmann::ordered_json(nullptr);
    if (trial) j["trial"] = grading::trial_json(*trial);
    j["session"] = o.out.empty() || !solved.result ? nlohmann::ordered_json(nullptr)
                                                   : nlohmann::ordered_json(o.out);
    print_json(j);
    return answer;
  }
  say(passed ? msg("{} on {}: the built-in expert passes", setup->scenario.id, setup->tooth.name)
             : msg("{} on {}: the built-in expert does NOT pass", setup->scenario.id,
                   setup->tooth.name));
  if (solved.result) {
    const grading::Result& r = *solved.result;
    const Number points{r.points, Unit::none, 1, r.points_bound},
        most = as_points(r.max_points), mark = as_percent(r.pass_percent, 0);
    const Term verdict = grading::word_of(r.verdict);
    say(r.compensatory
            ? msg("score: {} of {} points, {}; pass mark {}", points, most, verdict, mark)
            : msg("score: {} of {} points, {}; pass mark {} of each criterion", points, most,
                  verdict, mark));
    say(msg("time: {} of {} ({}), with {}", as_s(r.motion.time_s, 1), as_s(limit_s, 1),
            as_percent(100 * r.motion.time_s / limit_s, 0), solved.bur));
    say(msg("steps: {} of {} completed, ended: {}", r.progress.steps_completed, r.progress.steps,
            Term{finish_name(r.progress.finish)}));
    for (const auto& c : r.criteria)
      say(msg("{}: {} of {}, {}", c.id, as_points(c.points), as_points(c.max), c.reason()), 2);
  }
  for (const auto& reason : solved.reasons) say(msg("because: {}", reason.what()));
  if (!passed) say(msg("what to do: {}", solved.advice.what()));
  if (careless) say(to_text(*careless));
  if (trial) say_trial(*trial);
  if (solved.result && !o.out.empty()) say(msg("recorded: {}", o.out));
  return answer;
}

}  // namespace

void add_scenario_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<ScenarioArguments>();
  auto* verb = app.add_subcommand("scenario", tr("Write and check exam scenarios"));
  verb->require_subcommand(1);

  auto* checks = verb->add_subcommand(
      "check", tr("Name every mistake of a scenario file, and warn of what is unwise"));
  checks->add_option("scenario", o->scenario, tr("scenario file (TOML)"))->required();
  checks->add_option("--tooth", o->tooth, tr("check the zones against this tooth instead"));
  checks->add_flag("--json", o->json, tr("one JSON object on standard output"));
  checks->add_flag("--no-trial", o->no_trial, tr("do not try faulty preparations on the rubric"));
  checks->callback([o, &exit_code] { exit_code = check(*o); });

  auto* shows =
      verb->add_subcommand("show", tr("Draw the zones on three sections and from above (SVG)"));
  shows->add_option("scenario", o->scenario, tr("scenario file (TOML)"))->required();
  shows->add_option("--out", o->out, tr("SVG file"))->required();
  shows->add_option("--tooth", o->tooth, tr("draw them in this tooth instead"));
  shows->add_flag("--json", o->json, tr("one JSON object on standard output"));
  shows->callback([o, &exit_code] { exit_code = show(*o); });

  auto* solves = verb->add_subcommand(
      "solve", tr("Prove that the task can be passed: the built-in expert takes it"));
  solves->add_option("scenario", o->scenario, tr("scenario file (TOML)"))->required();
  solves->add_option("--tooth", o->tooth, tr("solve it on this tooth instead"));
  solves
      ->add_option("--model", o->model,
                   tr("force model: paper, consistent, clinical, or a TOML file"))
      ->capture_default_str();
  solves->add_option("--seed", o->seed, tr("of the expert's tremor"))
      ->check(seed_check())
      ->capture_default_str();
  solves->add_option("--out", o->out, tr("keep the recording: session file to write (.cavum)"));
  solves->add_flag(
      "--careless", o->careless,
      tr("also let the careless candidate take it: he must fail by the criterion that [careless] names"));
  solves->add_flag("--trial", o->trial,
                   tr("also mark faulty preparations by the rubric: none may pass"));
  solves->add_flag("--json", o->json, tr("one JSON object on standard output"));
  solves->callback([o, &exit_code] { exit_code = solve(*o); });

  auto* schema =
      verb->add_subcommand("schema", tr("Print the JSON Schema of a scenario file, for editors"));
  schema->callback([] { print_json(scenarios::scenario_schema()); });

  add_scenario_new(*verb, exit_code);
}

}  // namespace cavum::ui
