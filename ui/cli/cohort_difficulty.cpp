#include "ui/cli/cohort_difficulty.h"

#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
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
#include "ui/language/say.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

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

/// What was found of one form, and what to do about it.
Message verdict_words(const cohort::FormDifficulty& d) {
  using cohort::FormVerdict;
  switch (d.verdict) {
    case FormVerdict::alike:
      return msg("as hard as the others");
    case FormVerdict::doubtful:
      return msg("doubtful: not known well enough");
    case FormVerdict::too_easy:
      return d.depends_on_skill
                 ? msg("too easy; leave it out: no constant equates it")
                 : msg("too easy; leave it out, or show equated points beside the raw ones");
    case FormVerdict::too_hard:
      break;
  }
  return d.depends_on_skill
             ? msg("too hard; leave it out: no constant equates it")
             : msg("too hard; leave it out, or show equated points beside the raw ones");
}

Lines to_text(const cohort::FormsSat& sat, const cohort::FormsJudged& judged) {
  Lines out;
  out.add(msg("{} forms, each sat by the same {} simulated students; percent of a form's points",
              judged.forms.size(), judged.candidates));
  out.row({msg("form"), msg("mean"), msg("passed"), msg("easier than all forms"), msg("weak, able"),
           msg("constant"), msg("verdict")});
  bool doubtful = false;
  for (std::size_t f = 0; f < judged.forms.size(); ++f) {
    const cohort::FormDifficulty& d = judged.forms[f];
    doubtful = doubtful || d.verdict == cohort::FormVerdict::doubtful;
    out.row(
        {Name{sat.ids[f]}, msg("{}", Number{d.mean, Unit::none, 1, d.mean_error}),
         msg("{}", sat.passed[f]),
         msg("{} ({} to {})", as_number(d.easier, 1), as_number(d.low, 1), as_number(d.high, 1)),
         msg("{}, {}", as_number(d.easier_for_weak, 1), as_number(d.easier_for_able, 1)),
         msg("{}", as_number(d.constant, 1)), verdict_words(d)});
  }
  out.add(msg(
      "between forms: {} beyond chance; forms of equal difficulty differ as much in {} of 1000 draws",
      as_number(judged.spread, 1), as_number(1000 * judged.chance, 0)));
  out.add(msg("limit: {} to either side. Intervals hold in all forms at once in 95 of 100 exams",
              as_number(judged.limit, 1)));
  if (doubtful)
    out.add(msg("doubtful ones: some {} students would tell", candidates_needed(judged)));
  out.add(msg(
      "Simulated students are no people. No mark was changed: the constant is what equating by the mean would add."));
  return out;
}

/// 1 where a form is too easy or too hard.
int measure(const DifficultyArguments& o) {
  if (o.wanted.scenarios.size() < 2)
    throw Error(msg("cohort difficulty"), msg("needs two forms at least"),
                msg("name more scenario files"));
  if (!o.out.empty()) require_writable(o.out);
  const bool shown = !o.as_json && ::isatty(STDERR_FILENO) == 1;
  const std::size_t exams =
      o.wanted.scenarios.size() * static_cast<std::size_t>(o.wanted.candidates);
  const cohort::FormsSat sat = sit_forms(o.wanted, [&](int i) {
    if (shown) std::cerr << "\r" << tr("{} of {}", i, exams) << std::flush;
  });
  if (shown) std::cerr << "\r" << std::string(20, ' ') << "\r";
  const double limit = o.limit > 0                  ? o.limit
                       : sat.borderline_percent > 0 ? sat.borderline_percent
                                                    : k_usual_limit_percent;
  const std::vector<double> skill(sat.level.begin(), sat.level.end());
  const cohort::FormsJudged judged = cohort::judge_forms(sat.percent, skill, limit, o.wanted.seed);
  if (!o.out.empty()) write_text_file(o.out, marks_csv(sat));
  if (o.as_json)
    print_json(to_json(sat, judged));
  else
    say(to_text(sat, judged));
  return std::any_of(judged.forms.begin(), judged.forms.end(),
                     [](const cohort::FormDifficulty& d) {
                       return d.verdict == cohort::FormVerdict::too_easy ||
                              d.verdict == cohort::FormVerdict::too_hard;
                     })
             ? 1
             : 0;
}

}  // namespace

void add_cohort_difficulty(CLI::App& cohort, int& exit_code) {
  const auto o = std::make_shared<DifficultyArguments>();
  auto* v = cohort.add_subcommand(
      "difficulty",
      tr("Whether the forms of an exam are equally hard: the same simulated students sit each of them"));
  v->add_option("scenarios", o->wanted.scenarios, tr("scenario files (.toml), a form each"))
      ->required();
  v->add_option("--candidates", o->wanted.candidates,
                tr("simulated students, of skills from beginner to expert"))
      ->check(between(static_cast<int>(cohort::k_fewest_candidates), 1000))
      ->capture_default_str();
  v->add_option(
       "--limit", o->limit,
       tr("percent of the points from which on a form is too easy or too hard (default: the forms' borderline band, within which a person decides)"))
      ->check(between(0.1, 50));
  v->add_option("--seed", o->wanted.seed, tr("the same seed gives the same students"))
      ->check(seed_check())
      ->capture_default_str();
  v->add_option("--at-once", o->wanted.at_once, tr("exams side by side"))
      ->check(between(1, 16))
      ->capture_default_str();
  v->add_option("--out", o->out, tr("also every mark (.csv): a student a row, a form a column"));
  v->add_flag("--json", o->as_json, tr("one JSON object on stdout"));
  v->callback([o, &exit_code] { exit_code = measure(*o); });
}

}  // namespace cavum::ui
