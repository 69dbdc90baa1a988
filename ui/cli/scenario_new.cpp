#include "ui/cli/scenario_new.h"

#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/scratch_folder.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "grading/result/result_json.h"
#include "grading/trial/trial.h"
#include "scenarios/exam/exam.h"
#include "scenarios/review/task_texts.h"
#include "scenarios/review/tooth_task.h"
#include "ui/cli/solved_exam.h"
#include "ui/language/language.h"
#include "ui/language/say.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

using Json = nlohmann::ordered_json;

/// A tooth of data/teeth by the word that `--tooth` takes for it.
struct ShippedTooth {
  std::string_view word, file;
};
constexpr std::array<ShippedTooth, 4> k_shipped_teeth{{{"molar", "lower_molar.cvt"},
                                                       {"premolar", "upper_premolar.cvt"},
                                                       {"incisor", "upper_incisor.cvt"},
                                                       {"carious_molar", "molar_lesion.cvt"}}};

struct NewArguments {
  std::string tooth = "molar", task, out;
  bool force = false, list = false, json = false, untried = false;
  [[nodiscard]] bool on_the_block() const { return tooth == "block"; }
};

std::string tooth_names() {
  std::string names;
  for (const auto& t : k_shipped_teeth) names += std::string(t.word) + ", ";
  return names + "block";
}

/// The file of the tooth that `--tooth` names.
std::string tooth_file(const NewArguments& o) {
  if (o.tooth.ends_with(".cvt")) return o.tooth;
  for (const auto& t : k_shipped_teeth)
    if (t.word == o.tooth) return scenarios::find_data_file("teeth", std::string(t.file), o.out);
  throw Error(Name{"--tooth " + o.tooth}, msg("there is no such tooth to write a scenario for"),
              msg("choose {}, or a tooth file (.cvt)", tooth_names()));
}

/// A tooth's file as the scenario beside `out` names it: by its name where both lie together or it
/// ships, else by its whole path.
std::string named_from(const std::string& out, const std::string& tooth_file) {
  namespace fs = std::filesystem;
  for (const auto& t : k_shipped_teeth)
    if (fs::path(tooth_file).filename() == t.file &&
        fs::equivalent(tooth_file, scenarios::find_data_file("teeth", std::string(t.file), out)))
      return std::string(t.file);
  const fs::path tooth = fs::absolute(tooth_file).lexically_normal(),
                 folder = fs::absolute(out).lexically_normal().parent_path();
  return tooth.parent_path() == folder ? tooth.filename().string() : tooth.string();
}

int list_tasks(const NewArguments& o) {
  if (o.on_the_block())
    throw Error(Name{"--list"}, msg("is for a tooth"),
                msg("tasks on the block: {}", list_of(scenarios::block_task_words())));
  const Tooth tooth = load_tooth_file(tooth_file(o));
  const auto offered = scenarios::offered_tasks(tooth, find_landmarks(tooth));
  if (o.json) {
    Json tasks = Json::array();
    for (const auto& t : offered)
      tasks.push_back({{"task", t.task},
                       {"title", t.title},
                       {"offered", t.why_not.empty()},
                       {"why_not", t.why_not}});
    print_json(Json{{"tooth", tooth.name}, {"tasks", tasks}});
    return 0;
  }
  Lines rows;
  for (const auto& t : offered)
    rows.row({Name{t.task},
              t.why_not.empty() ? t.title : msg("{}; NOT offered: {}", t.title, t.why_not)});
  say(rows);
  return 0;
}

/// What the last task that was tried showed.
struct Trial {
  double expert_percent = 0;
  std::size_t faulty_preparations = 0;
};

/// What is against a written task as an exam: the expert must pass with nine tenths of the points,
/// and no faulty preparation may.
Message against(const std::string& text, const std::string& file, Trial& trial) {
  constexpr double k_min_percent = 90.0;
  const ScratchFolder scratch;
  const std::string scenario = scratch.file("task.toml");
  write_text_file(scenario, text);
  scenarios::ExamOptions options;
  options.candidate = "built-in expert";
  options.tooth_file = file;
  const auto setup = scenarios::prepare_exam(scenario, options);
  const Solved solved = solve_exam(*setup, 1, scratch.file("expert.cavum"));
  if (!solved.result) return solved.reasons.front().what();
  trial.expert_percent = 100.0 * solved.result->points / solved.result->max_points;
  if (solved.result->verdict != grading::Verdict::pass || trial.expert_percent < k_min_percent) {
    const Number percent = as_percent(trial.expert_percent, 0);
    const Term verdict = grading::word_of(solved.result->verdict);
    return solved.reasons.empty()
               ? msg("the built-in expert gets {} of the points ({})", percent, verdict)
               : msg("the built-in expert gets {} of the points ({}): {}", percent, verdict,
                     List{words_of(solved.reasons), true});
  }
  const grading::Trial table =
      grading::run_trial(setup->scenario, setup->tooth, setup->zones, grading::Look::screened);
  trial.faulty_preparations = table.rows.size();
  for (const auto& p : table.problems)
    if (!p.warning) return p.what;
  return {};
}

/// What is written has its words in the reader's language, too.
scenarios::TaskLanguage readers_language() {
  if (language() == "en") return {};
  return {language(), [](const Message& m) { return tr(m); }};
}

/// By the tooth's landmarks.
int make_for_tooth(const NewArguments& o) {
  const std::string file = tooth_file(o);
  const Tooth tooth = load_tooth_file(file);
  const Landmarks landmarks = find_landmarks(tooth);
  std::string task = o.task;
  for (const auto& t : scenarios::offered_tasks(tooth, landmarks))
    if (task.empty() && t.why_not.empty()) task = t.task;
  if (task.empty())
    throw Error(Name{o.tooth}, msg("no task makes sense on this tooth"),
                msg("see why: cavum scenario new --list --tooth {}", o.tooth));
  Trial trial;
  scenarios::TaskTrial tried;
  if (!o.untried) tried = [&](const std::string& text) { return against(text, file, trial); };
  const scenarios::WrittenTask written = scenarios::write_tooth_task(
      tooth, landmarks, named_from(o.out, file), o.out, task, tried, readers_language());
  write_text_file(o.out, written.text, {.may_replace = o.force});
  if (o.json) {
    Json warnings = Json::array();
    for (const auto& p : written.problems) warnings.push_back(english_text(p.message()));
    Json shown = nullptr;
    if (!o.untried)
      shown = {{"expert_percent", std::round(10 * trial.expert_percent) / 10},
               {"faulty_preparations", trial.faulty_preparations}};
    print_json(Json{{"written", o.out},
                    {"tried", shown},
                    {"tooth", tooth.name},
                    {"task", task},
                    {"chosen", written.chosen},
                    {"warnings", warnings},
                    {"tooth_guesses", tooth.notes_of(ToothNote::Kind::guess)},
                    {"tooth_notices", tooth.notes_of(ToothNote::Kind::warning)}});
    return 0;
  }
  say(msg("written: {}; {} on {}: {}", o.out, task, tooth.name, written.chosen));
  for (const auto& p : written.problems) say(p.message());
  for (const auto& warning : tooth.notes_of(ToothNote::Kind::warning))
    say(msg("notice: {}", warning));
  if (o.untried) {
    say(msg("next: {}",
            fmt::format("cavum scenario show {} --out F.svg && cavum scenario solve {} --trial",
                        o.out, o.out)));
  } else {
    say(msg(
        "tried: the built-in expert passes with {} of the points; none of {} faulty preparations passes",
        as_percent(trial.expert_percent, 0), trial.faulty_preparations));
    say(msg("next: {}", fmt::format("cavum scenario show {} --out F.svg", o.out)));
  }
  return 0;
}

int make_new(const NewArguments& o) {
  if (o.list) return list_tasks(o);
  if (o.out.empty()) throw Error(Name{"--out"}, msg("is missing"), msg("name the file to write"));
  require_writable(o.out);
  if (std::filesystem::exists(o.out) && !o.force)
    throw Error(Name{o.out}, msg("the file exists already"),
                msg("choose another name, or overwrite it with --force"));
  if (!o.on_the_block()) return make_for_tooth(o);
  const std::string text = scenarios::block_task(o.task.empty() ? "class_1" : o.task);
  const scenarios::Scenario scenario = scenarios::parse_scenario(text, o.out);
  const Message title = msg("{}", Term{scenario.title}),
                description = msg("{}", Term{scenario.description});
  write_text_file(
      o.out, text + scenarios::language_table(scenario, title, description, readers_language()),
      {.may_replace = o.force});
  if (o.json)
    print_json(Json{{"written", o.out}});
  else
    say(msg("written: {}; next: {}", o.out, "cavum scenario check " + o.out));
  return 0;
}

}  // namespace

void add_scenario_new(CLI::App& scenario, int& exit_code) {
  const auto o = std::make_shared<NewArguments>();
  auto* news = scenario.add_subcommand("new", tr("Write a commented scenario to start from"));
  news->add_option("--tooth", o->tooth, tr("{}, or a tooth file (.cvt)", as_is(tooth_names())))
      ->capture_default_str();
  news->add_option(
      "--task", o->task,
      tr("on a tooth, whose landmarks the zones follow: {}; on the block: {}; left out: the first that there is",
         list_of(scenarios::tooth_task_words()), list_of(scenarios::block_task_words())));
  news->add_option("--out", o->out, tr("file to write"));
  news->add_flag("--list", o->list,
                 tr("which tasks make sense on the tooth, and why others do not"));
  news->add_flag(
      "--untried", o->untried,
      tr("write a task for a tooth without trying it: the expert need not pass, faulty preparations may"));
  news->add_flag("--force", o->force, tr("overwrite"));
  news->add_flag("--json", o->json, tr("one JSON object on standard output"));
  news->callback([o, &exit_code] { exit_code = make_new(*o); });
}

}  // namespace cavum::ui
