#include "ui/verbs/cohort_difficulty.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/text.h"
#include "grading/cohort/form_difficulty.h"
#include "grading/cohort/sit_forms.h"
#include "ui/parts/number_check.h"
#include "ui/parts/print_json.h"
#include "ui/parts/seed_check.h"

namespace cavum::ui {
namespace {

struct DifficultyArguments {
  cohort::FormsWanted wanted;
  double limit = 0.0;
  std::string out;
  bool as_json = false;
};

constexpr double k_usual_limit_percent = 3.0;  // where no form has a borderline band

std::string marks_csv(const cohort::FormsSat& sat) {
  std::string text = "student,seed";
  for (const auto& id : sat.ids) text += "," + id;
  for (std::size_t c = 0; c < sat.percent.size(); ++c) {
    text += fmt::format("\nstudent-{},{}", sat.level[c], sat.seed[c]);
    for (const double v : sat.percent[c]) text += "," + fixed(v, 3);
  }
  return text + "\n";
}

nlohmann::ordered_json to_json(const cohort::FormsSat& sat, const cohort::FormsJudged& judged) {
  nlohmann::ordered_json j{{"candidates", judged.candidates},
                           {"pass_percent", sat.pass_percent},
                           {"limit_percent", judged.limit},
                           {"spread_percent", judged.spread},
                           {"chance", judged.chance},
                           {"critical", judged.critical},
                           {"candidates_needed", candidates_needed(judged)},
                           {"forms", nlohmann::ordered_json::array()}};
  for (std::size_t f = 0; f < judged.forms.size(); ++f) {
    const cohort::FormDifficulty& d = judged.forms[f];
    j["forms"].push_back({{"id", sat.ids[f]},
                          {"mean_percent", d.mean},
                          {"mean_error", d.mean_error},
                          {"passed", sat.passed[f]},
                          {"easier_percent", d.easier},
                          {"easier_error", d.easier_error},
                          {"low", d.low},
                          {"high", d.high},
                          {"easier_for_weak", d.easier_for_weak},
                          {"easier_for_able", d.easier_for_able},
                          {"depends_on_skill", d.depends_on_skill},
                          {"verdict", form_verdict_name(d.verdict)},
                          {"constant_percent", d.constant}});
  }
  return j;
}

/// What to do about one form.
std::string advice(const cohort::FormDifficulty& d) {
  using cohort::FormVerdict;
  if (d.verdict == FormVerdict::alike) return "";
  if (d.verdict == FormVerdict::doubtful) return "not known well enough";
  return d.depends_on_skill ? "leave it out: no constant equates it" : "leave it out, or show equated points beside the raw ones";
}

std::string to_text(const cohort::FormsSat& sat, const cohort::FormsJudged& judged) {
  std::string s = fmt::format(
      "{} forms, each sat by the same {} simulated students; percent of a form's points\n"
      "{:<32} {:>12} {:>7} {:>22} {:>12} {:>9}  {}\n",
      judged.forms.size(), judged.candidates, "form", "mean", "passed", "easier than all forms", "weak, able", "constant", "verdict");
  bool doubtful = false;
  for (std::size_t f = 0; f < judged.forms.size(); ++f) {
    const cohort::FormDifficulty& d = judged.forms[f];
    const std::string to_do = advice(d);
    doubtful = doubtful || d.verdict == cohort::FormVerdict::doubtful;
    s += fmt::format("{:<32} {:>12} {:>7} {:>22} {:>12} {:>9}  {}{}\n", one_line(sat.ids[f]), fixed(d.mean, 1) + " ± " + fixed(d.mean_error, 1),
                     sat.passed[f], fmt::format("{} ({} to {})", fixed(d.easier, 1), fixed(d.low, 1), fixed(d.high, 1)),
                     fixed(d.easier_for_weak, 1) + ", " + fixed(d.easier_for_able, 1), fixed(d.constant, 1), form_verdict_name(d.verdict),
                     to_do.empty() ? "" : "; " + to_do);
  }
  s += fmt::format("between forms: {} beyond chance; forms of equal difficulty differ as much in {} of 1000 draws\n", fixed(judged.spread, 1),
                   fixed(1000 * judged.chance, 0));
  s += fmt::format("limit: {} to either side. Intervals hold in all forms at once in 95 of 100 exams\n", fixed(judged.limit, 1));
  if (doubtful) s += fmt::format("doubtful ones: some {} students would tell\n", candidates_needed(judged));
  return s + "Simulated students are no people. No mark was changed: the constant is what equating by the mean would add.\n";
}

/// 1 where a form is too easy or too hard.
int measure(const DifficultyArguments& o) {
  if (o.wanted.scenarios.size() < 2) throw Error(msg("cohort difficulty"), msg("needs two forms at least"), msg("name more scenario files"));
  if (!o.out.empty()) require_writable(o.out);
  const bool shown = !o.as_json && ::isatty(STDERR_FILENO) == 1;
  const std::size_t exams = o.wanted.scenarios.size() * static_cast<std::size_t>(o.wanted.candidates);
  const cohort::FormsSat sat = sit_forms(o.wanted, [&](int i) {
    if (shown) std::fprintf(stderr, "\r%d of %zu", i, exams);
  });
  if (shown) std::fprintf(stderr, "\r%20s\r", "");
  const double limit = o.limit > 0 ? o.limit : sat.borderline_percent > 0 ? sat.borderline_percent : k_usual_limit_percent;
  const std::vector<double> skill(sat.level.begin(), sat.level.end());
  const cohort::FormsJudged judged = cohort::judge_forms(sat.percent, skill, limit, o.wanted.seed);
  if (!o.out.empty()) write_text_file(o.out, marks_csv(sat));
  if (o.as_json)
    print_json(to_json(sat, judged));
  else
    std::cout << to_text(sat, judged);
  return std::any_of(
             judged.forms.begin(), judged.forms.end(),
             [](const cohort::FormDifficulty& d) { return d.verdict == cohort::FormVerdict::too_easy || d.verdict == cohort::FormVerdict::too_hard; })
             ? 1
             : 0;
}

}  // namespace

void add_cohort_difficulty(CLI::App& cohort, int& exit_code) {
  const auto o = std::make_shared<DifficultyArguments>();
  auto* v = cohort.add_subcommand("difficulty", "Whether the forms of an exam are equally hard: the same simulated students sit each of them");
  v->add_option("scenarios", o->wanted.scenarios, "scenario files (.toml), a form each")->required();
  v->add_option("--candidates", o->wanted.candidates, "simulated students, of skills from beginner to expert")
      ->check(CLI::Range(static_cast<int>(cohort::k_fewest_candidates), 1000))
      ->capture_default_str();
  v->add_option(
       "--limit", o->limit,
       "percent of the points from which on a form is too easy or too hard (default: the forms' borderline band, within which a person decides)")
      ->check(between(0.1, 50));
  v->add_option("--seed", o->wanted.seed, "the same seed gives the same students")->check(seed_check())->capture_default_str();
  v->add_option("--at-once", o->wanted.at_once, "exams side by side")->check(CLI::Range(1, 16))->capture_default_str();
  v->add_option("--out", o->out, "also every mark (.csv): a student a row, a form a column");
  v->add_flag("--json", o->as_json, "one JSON object on stdout");
  v->callback([o, &exit_code] { exit_code = measure(*o); });
}

}  // namespace cavum::ui
