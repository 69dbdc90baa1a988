#include "ui/verbs/scenario_new.h"

#include <fmt/core.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/text.h"
#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/tooth_notes.h"
#include "scenarios/file/template.h"
#include "scenarios/review/tooth_task.h"
#include "ui/parts/print_json.h"

namespace cavum::ui {
namespace {

using Json = nlohmann::ordered_json;

struct NewArguments {
  std::string tooth = "molar", task, out;
  bool force = false, list = false, json = false;
  [[nodiscard]] bool own_tooth() const { return tooth.ends_with(".cvt"); }
};

/// The task that is written when none is named: a class I where the tooth has one.
std::string first_task(const std::string& tooth) {
  std::string first = "class_1";  // of an unknown tooth, which is refused with all choices
  bool any = false;
  for (const auto& c : scenarios::template_choices()) {
    if (c.tooth != tooth || (any && c.task != "class_1")) continue;
    first = c.task;
    any = true;
  }
  return first;
}

/// A tooth's file as the scenario beside `out` names it: by its name where both lie together, else by its whole path.
std::string named_from(const std::string& out, const std::string& tooth_file) {
  namespace fs = std::filesystem;
  const fs::path tooth = fs::absolute(tooth_file).lexically_normal(), folder = fs::absolute(out).lexically_normal().parent_path();
  return tooth.parent_path() == folder ? tooth.filename().string() : tooth.string();
}

int list_tasks(const NewArguments& o) {
  if (!o.own_tooth()) throw Error("--list", "is for a tooth file", "name one: --tooth mine.cvt");
  const Tooth tooth = load_tooth_file(o.tooth);
  const auto offered = scenarios::offered_tasks(tooth, find_landmarks(tooth));
  if (o.json) {
    Json tasks = Json::array();
    for (const auto& t : offered) tasks.push_back({{"task", t.task}, {"title", t.title}, {"offered", t.why_not.empty()}, {"why_not", t.why_not}});
    print_json(Json{{"tooth", tooth.name}, {"tasks", tasks}});
    return 0;
  }
  for (const auto& t : offered)
    std::cout << fmt::format("{:<15} {}{}\n", t.task, t.title, t.why_not.empty() ? std::string() : "; NOT offered: " + one_line(t.why_not));
  return 0;
}

/// By the landmarks of a tooth of one's own.
int make_for_tooth(const NewArguments& o) {
  const Tooth tooth = load_tooth_file(o.tooth);
  const Landmarks landmarks = find_landmarks(tooth);
  std::string task = o.task;
  for (const auto& t : scenarios::offered_tasks(tooth, landmarks))
    if (task.empty() && t.why_not.empty()) task = t.task;
  if (task.empty()) throw Error(o.tooth, "no task makes sense on this tooth", "see why: cavum scenario new --list --tooth " + o.tooth);
  const scenarios::WrittenTask written = scenarios::write_tooth_task(tooth, landmarks, named_from(o.out, o.tooth), o.out, task);
  write_text_file(o.out, written.text, {.may_replace = o.force});
  const ToothNotes notes = notes_of(tooth);
  if (o.json) {
    Json warnings = Json::array();
    for (const auto& p : written.problems) warnings.push_back(p.text());
    print_json(Json{{"written", o.out},
                    {"tooth", tooth.name},
                    {"task", task},
                    {"chosen", written.chosen},
                    {"warnings", warnings},
                    {"tooth_guesses", notes.guesses},
                    {"tooth_notices", notes.warnings}});
    return 0;
  }
  std::cout << "written: " << o.out << "; " << task << " on " << one_line(tooth.name) << ": " << written.chosen << "\n";
  for (const auto& p : written.problems) std::cout << one_line(p.text()) << "\n";
  for (const auto& warning : notes.warnings) std::cout << "notice: " << one_line(warning) << "\n";
  std::cout << "next: cavum scenario show " << o.out << " --out F.svg && cavum scenario solve " << o.out << "\n";
  return 0;
}

int make_new(const NewArguments& o) {
  if (o.list) return list_tasks(o);
  if (o.out.empty()) throw Error("--out", "is missing", "name the file to write");
  require_writable(o.out);
  if (std::filesystem::exists(o.out) && !o.force) throw Error(o.out, "the file exists already", "choose another name, or overwrite it with --force");
  if (o.own_tooth()) return make_for_tooth(o);
  write_text_file(o.out, scenarios::scenario_template(o.tooth, o.task.empty() ? first_task(o.tooth) : o.task), {.may_replace = o.force});
  if (o.json)
    print_json(Json{{"written", o.out}});
  else
    std::cout << "written: " << o.out << "; next: cavum scenario check " << o.out << "\n";
  return 0;
}

}  // namespace

void add_scenario_new(CLI::App& scenario, int& exit_code) {
  const auto o = std::make_shared<NewArguments>();
  auto* news = scenario.add_subcommand("new", "Write a commented scenario to start from");
  std::string known, words;
  for (const auto& c : scenarios::template_choices()) known += fmt::format("{}{} {}", known.empty() ? "" : ", ", c.tooth, c.task);
  for (const auto& w : scenarios::tooth_task_words()) words += (words.empty() ? "" : ", ") + w;
  news->add_option("--tooth", o->tooth,
                   fmt::format("kind of tooth, with the task one of: {}; or a tooth file (.cvt), whose landmarks the zones follow, with one of: {}",
                               known, words))
      ->capture_default_str();
  news->add_option("--task", o->task, "kind of task; when it is left out, class_1 or the first that there is for the tooth");
  news->add_option("--out", o->out, "file to write");
  news->add_flag("--list", o->list, "of a tooth file: which tasks make sense on it, and why others do not");
  news->add_flag("--force", o->force, "overwrite");
  news->add_flag("--json", o->json, "one JSON object on standard output");
  news->callback([o, &exit_code] { exit_code = make_new(*o); });
}

}  // namespace cavum::ui
