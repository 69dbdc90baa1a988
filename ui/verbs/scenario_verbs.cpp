// `cavum scenario check | show | solve`: authoring help.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/kept.h"
#include "engine/base/scratch_folder.h"
#include "engine/base/text.h"
#include "engine/language/shown.h"
#include "engine/tooth/tooth.h"
#include "grading/battery/battery_output.h"
#include "grading/result/result_json.h"
#include "grading/session_input.h"
#include "scenarios/candidates/simulated_exam.h"
#include "scenarios/exam/exam.h"
#include "scenarios/file/parse.h"
#include "scenarios/review/check.h"
#include "scenarios/review/picture.h"
#include "scenarios/zones/zone_map.h"
#include "ui/parts/print_json.h"
#include "ui/parts/seed_check.h"
#include "ui/verbs/scenario_new.h"
#include "ui/verbs/solved_exam.h"
#include "ui/verbs/verbs.h"

namespace cavum::ui {
namespace {

struct ScenarioArguments {
  std::string scenario, tooth, out, model = "consistent";
  std::uint64_t seed = 1;
  bool json = false, careless = false, battery = false, no_battery = false;
};

int check(const ScenarioArguments& o) {
  scenarios::CheckedScenario checked = scenarios::check_whole(read_text_file(o.scenario), o.scenario, o.tooth);
  if (checked.laid && !o.no_battery) {
    const grading::Battery battery = grading::run_battery(checked.laid->scenario, checked.laid->tooth, checked.laid->zones, grading::Look::screened);
    checked.problems.insert(checked.problems.end(), battery.problems.begin(), battery.problems.end());
    scenarios::sort_problems(checked.problems);
  }
  if (o.json) {
    nlohmann::ordered_json j{{"scenario", o.scenario}, {"sound", checked.sound()}, {"problems", nlohmann::ordered_json::array()}};
    for (const auto& p : checked.problems)
      j["problems"].push_back({{"severity", p.warning ? "warning" : "error"},
                               {"where", english_text(p.where)},
                               {"line", p.where.line},
                               {"column", p.where.column},
                               {"what", english_text(p.what)},
                               {"what_to_do", english_text(p.what_to_do)}});
    j["expert_s"] = checked.expert.time_s ? nlohmann::ordered_json(std::round(*checked.expert.time_s)) : nlohmann::ordered_json(nullptr);
    if (checked.expert.time_s) j["expert_reach_percent"] = std::round(100 * checked.expert.reach);
    print_json(j);
  } else {
    for (const auto& p : checked.problems) std::cout << one_line(english_text(p.message())) << "\n";
    if (checked.sound()) {
      const auto n = checked.problems.size();
      std::cout << o.scenario << ": " << (n == 0 ? "sound" : fmt::format("no mistakes, {}{}", n, n == 1 ? " warning" : " warnings"));
      if (checked.expert.time_s)
        std::cout << "; the built-in expert needs about " << fixed(*checked.expert.time_s, 0) << " s and reaches "
                  << fixed(100 * checked.expert.reach, 0) << " % of the cavity";
      std::cout << (n == 0 ? "" : "; whether it can be passed: cavum scenario solve " + o.scenario) << "\n";
    }
  }
  return checked.sound() ? 0 : 1;
}

/// Volumes of the zones in the tooth, each with half a leaf over its border; the target's by parts of leaves, as it is graded.
std::array<grading::BoundedVolume, scenarios::k_zones> zone_volumes(const Tooth& tooth, const scenarios::ZoneMap& zones) {
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
      static_cast<double>(zones.target_shares()) / static_cast<double>(scenarios::ZoneMap::k_share_units) * leaf_mm3,
      0.5 * static_cast<double>(zones.target_border_leaves()) * leaf_mm3};
  return volumes;
}

int show(const ScenarioArguments& o) {
  if (!o.out.ends_with(".svg")) throw Error(o.out, msg("the zones are drawn as SVG only"), msg("use a name ending in .svg"));
  require_writable(o.out);
  const scenarios::Scenario s = scenarios::load_scenario(o.scenario);
  const Tooth tooth = load_tooth_file(o.tooth.empty() ? scenarios::find_tooth_file(s) : o.tooth);
  const scenarios::ZoneMap zones = scenarios::build_zones(s, tooth);
  const std::string svg = scenarios::scenario_sheet_svg(s, tooth, zones);
  write_text_file(o.out, svg);
  const auto volumes = zone_volumes(tooth, zones);
  if (o.json) {
    nlohmann::ordered_json j{{"out", o.out},
                             {"tooth", tooth.name},
                             {"opening_z_mm", zones.opening_z_mm()},
                             {"zones_mm3", nlohmann::ordered_json::object()},
                             {"bounds_mm3", nlohmann::ordered_json::object()}};
    for (std::size_t z = 1; z < scenarios::k_zones; ++z) {
      j["zones_mm3"][scenarios::zone_name(static_cast<scenarios::Zone>(z))] = grading::rounded(volumes[z].mm3);
      j["bounds_mm3"][scenarios::zone_name(static_cast<scenarios::Zone>(z))] = grading::rounded(volumes[z].bound_mm3);
    }
    print_json(j);
    return 0;
  }
  for (std::size_t z = 1; z < scenarios::k_zones; ++z)
    std::cout << scenarios::zone_name(static_cast<scenarios::Zone>(z)) << ": " << fixed(volumes[z].mm3, 2) << " ± " << fixed(volumes[z].bound_mm3, 2)
              << " mm3\n";
  std::cout << "drawn: " << o.out << "\n";
  return 0;
}

/// The careless candidate's exam: whether it was failed, and by the criterion that the scenario names.
struct Caught {
  grading::Result result;
  grading::CriterionResult criterion;
  bool as_named = false;
  std::string advice;  ///< what to change when it is not caught
};

/// Why the careless candidate got away, and what to do about it.
std::string advice_for(const Caught& c) {
  const grading::CriterionResult& named = c.criterion;
  const bool lost_all = named.critical_failed || named.points <= 0;
  if (c.result.progress.finish == Finish::time)
    return "time ran out before the mistake told: allow more time, or make the mistake in [careless] quicker to see";
  if (lost_all && c.result.verdict == grading::Verdict::review)
    return fmt::format("a person would have to decide: make '{}' critical, or raise the pass mark by more than the borderline band", named.id);
  if (lost_all)
    return fmt::format(
        "'{}' gives no points, but the others make up for it: set its critical_above or critical_below, or make the rubric non-compensatory",
        named.id);
  const std::string value = named.value ? fixed(*named.value, 2) + (named.unit.empty() ? "" : " " + named.unit) : "no value";
  return fmt::format(
      "'{}' still gives {} of {} points for {}: make the mistake in [careless] larger, or the criterion stricter so that it gives none for that, or "
      "let fails_by name another",
      named.id, fixed(named.points, 1), fixed(named.max, 1), value);
}

Caught catch_careless(const ScenarioArguments& o, const scenarios::ExamSetup& setup, const std::string& session) {
  scenarios::SimulatedCandidate candidate = scenarios::make_simulated_candidate(setup, "careless", o.seed, OmniModel{});
  Caught c{sat_by(setup, candidate, session), {}, false, {}};
  for (const auto& one : c.result.criteria)
    if (one.id == setup.scenario.careless.fails_by) c.criterion = one;
  // running out of time is another reason than the one the task is there for
  c.as_named = c.result.verdict == grading::Verdict::fail && c.result.progress.finish != Finish::time &&
               (c.criterion.critical_failed || c.criterion.points <= 0);
  if (!c.as_named) c.advice = advice_for(c);
  return c;
}

nlohmann::ordered_json to_json(const Caught& c) {
  const auto result = grading::to_json(c.result);
  nlohmann::ordered_json j{{"fails_by", c.criterion.id}, {"caught", c.as_named}, {"reason", c.criterion.reason}, {"what_to_do", c.advice}};
  for (const char* key : {"verdict", "score", "time_s", "finish", "criteria"}) j[key] = result[key];
  return j;
}

std::string to_text(const Caught& c) {
  std::string s = fmt::format("careless: {}{} ({}); {} of {} points, {}\n", c.as_named ? "failed by " : "NOT failed by ", kept(c.criterion.id),
                              c.criterion.reason, fixed(c.result.points, 1), fixed(c.result.max_points, 1), grading::verdict_name(c.result.verdict));
  if (c.as_named) return s;
  for (const auto& reason : c.result.verdict_reasons) s += fmt::format("because: {}\n", english_text(reason.message()));
  s += fmt::format("what to do: {}\n", c.advice);
  return s;
}

std::string to_text(const grading::Battery& battery) {
  std::string s = fmt::format("wrong work, marked by this rubric ({} pieces in {} s):\n{}", battery.rows.size(), fixed(battery.wall_s, 1),
                              grading::battery_text(battery));
  for (const auto& p : battery.problems) s += one_line(english_text(p.message())) + "\n";
  return s;
}

int solve(const ScenarioArguments& o) {
  if (!o.out.empty()) require_writable(o.out);
  scenarios::ExamOptions options;
  options.candidate = "built-in expert";
  options.tooth_file = o.tooth;
  options.force_model = o.model;
  options.device = "simulated Omni, operator expert";
  options.notes = {{"operator", "expert"}, {"operator_seed", std::to_string(o.seed)}};
  const auto setup = scenarios::prepare_exam(o.scenario, options);
  if (o.careless && setup->scenario.careless.fails_by.empty())
    throw Error(o.scenario, msg("the scenario says nothing of a careless candidate"),
                msg("add [careless] with the mistake it is to catch, or leave out --careless"));
  const ScratchFolder scratch;
  const Solved solved = solve_exam(*setup, o.seed, o.out.empty() ? scratch.file("expert.cavum") : o.out);
  const bool passed = solved.result && solved.result->verdict == grading::Verdict::pass;
  std::optional<Caught> careless;
  if (o.careless && solved.result) careless = catch_careless(o, *setup, scratch.file("careless.cavum"));
  std::optional<grading::Battery> battery;
  if (o.battery) battery = grading::run_battery(setup->scenario, setup->tooth, setup->zones, grading::Look::screened);
  const bool wrong_passes =
      battery && std::any_of(battery->problems.begin(), battery->problems.end(), [](const scenarios::Problem& p) { return !p.warning; });
  const int answer = passed && (!o.careless || (careless && careless->as_named)) && !wrong_passes ? 0 : 1;
  const double limit_s = static_cast<double>(scenarios::exam_limit_ticks(setup->scenario)) * k_tick_s;
  if (o.json) {
    nlohmann::ordered_json j{{"scenario", o.scenario}, {"tooth", setup->tooth.name}, {"passed", passed}, {"time_limit_s", limit_s}};
    if (solved.result) {
      j["point"] = solved.point;
      auto result = grading::to_json(*solved.result);
      for (const char* key : {"verdict", "score", "time_s", "finish", "steps", "criteria"}) j[key] = result[key];
    }
    j["reasons"] = solved.reasons;
    j["what_to_do"] = solved.advice;
    if (o.careless) j["careless"] = careless ? to_json(*careless) : nlohmann::ordered_json(nullptr);
    if (battery) j["battery"] = grading::battery_json(*battery);
    j["session"] = o.out.empty() || !solved.result ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(o.out);
    print_json(j);
    return answer;
  }
  std::cout << one_line(fmt::format("{} on {}", setup->scenario.id, setup->tooth.name)) << ": "
            << (passed ? "the built-in expert passes" : "the built-in expert does NOT pass") << "\n";
  if (solved.result) {
    const grading::Result& r = *solved.result;
    std::cout << "score  " << fixed(r.points, 1) << " ± " << fixed(r.points_bound, 1) << " of " << fixed(r.max_points, 1) << " points, "
              << grading::verdict_name(r.verdict) << "; pass mark " << fixed(r.pass_percent, 0) << " %"
              << (r.compensatory ? "" : " of each criterion") << "\ntime   " << fixed(r.motion.time_s, 1) << " s of " << fixed(limit_s, 1) << " s ("
              << fixed(100 * r.motion.time_s / limit_s, 0) << " %), with " << solved.point << "\nsteps  " << r.progress.steps_completed << " of "
              << r.progress.steps << " completed, ended: " << finish_name(r.progress.finish) << "\n";
    for (const auto& c : r.criteria)
      std::cout << "  " << kept(one_line(c.id)) << ": " << fixed(c.points, 1) << " of " << fixed(c.max, 1) << ", " << one_line(c.reason) << "\n";
  }
  for (const auto& reason : solved.reasons) std::cout << "because: " << one_line(reason) << "\n";
  if (!passed) std::cout << "what to do: " << one_line(solved.advice) << "\n";
  if (careless) std::cout << to_text(*careless);
  if (battery) std::cout << to_text(*battery);
  if (solved.result && !o.out.empty()) std::cout << "recorded: " << o.out << "\n";
  return answer;
}

}  // namespace

void add_scenario_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<ScenarioArguments>();
  auto* verb = app.add_subcommand("scenario", "Write and check exam scenarios");
  verb->require_subcommand(1);

  auto* checks = verb->add_subcommand("check", "Name every mistake of a scenario file, and warn of what is unwise");
  checks->add_option("scenario", o->scenario, "scenario file (TOML)")->required();
  checks->add_option("--tooth", o->tooth, "check the zones against this tooth instead");
  checks->add_flag("--json", o->json, "one JSON object on standard output");
  checks->add_flag("--no-battery", o->no_battery, "do not try wrong pieces of work on the rubric");
  checks->callback([o, &exit_code] { exit_code = check(*o); });

  auto* shows = verb->add_subcommand("show", "Draw the zones on three sections and from above (SVG)");
  shows->add_option("scenario", o->scenario, "scenario file (TOML)")->required();
  shows->add_option("--out", o->out, "SVG file")->required();
  shows->add_option("--tooth", o->tooth, "draw them in this tooth instead");
  shows->add_flag("--json", o->json, "one JSON object on standard output");
  shows->callback([o, &exit_code] { exit_code = show(*o); });

  auto* solves = verb->add_subcommand("solve", "Prove that the task can be passed: the built-in expert takes it");
  solves->add_option("scenario", o->scenario, "scenario file (TOML)")->required();
  solves->add_option("--tooth", o->tooth, "solve it on this tooth instead");
  solves->add_option("--model", o->model, "force model: paper, consistent, clinical, or a TOML file")->capture_default_str();
  solves->add_option("--seed", o->seed, "of the expert's tremor")->check(seed_check())->capture_default_str();
  solves->add_option("--out", o->out, "keep the recording: session file to write (.cavum)");
  solves->add_flag("--careless", o->careless, "also let the careless candidate take it: he must fail by the criterion that [careless] names");
  solves->add_flag("--battery", o->battery, "also mark wrong pieces of work by the rubric: none may pass");
  solves->add_flag("--json", o->json, "one JSON object on standard output");
  solves->callback([o, &exit_code] { exit_code = solve(*o); });

  add_scenario_new(*verb, exit_code);
}

}  // namespace cavum::ui
