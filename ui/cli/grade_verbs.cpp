// `cavum grade`: recorded exams, marked.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "grading/feedback/measures_page.h"
#include "grading/feedback/why.h"
#include "grading/result/compare.h"
#include "grading/result/result_json.h"
#include "scenarios/review/advice.h"
#include "ui/cli/marked_session.h"
#include "ui/cli/session_files.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

using Json = nlohmann::ordered_json;

struct GradeArguments {
  std::vector<std::string> sessions;
  std::string why, out;
  MarkingOptions marking;
  bool json = false, measures = false;
};

/// The result with its contract names, and beside it the old one where another rubric or scenario
/// was asked for.
Json json_of(const MarkedSession& g) {
  Json j = grading::with_words(grading::to_json(g.result));
  if (g.regrade) j["regrade"] = grading::to_json(*g.comparison);
  return j;
}

void write_new(const std::string& path, const Json& grades) {
  write_text_file(path, grades.dump(2, ' ', false, Json::error_handler_t::replace) + "\n",
                  {.may_replace = false});
}

void say_regrade(const MarkedSession& g) {
  if (!g.regrade) return;
  say(msg("REGRADE: {}", grading::regrade_text(*g.comparison)));
  std::cout << "\n";
}

void run_grade_one(const std::string& path, const GradeArguments& o) {
  grading::ExamContexts grounds;
  const MarkedSession g = marked_session(path, o.marking, grounds);
  if (!o.marking.rubric.empty())
    for (const auto& p : scenarios::advise_rubric(g.session->scenario, g.rubric, *g.session->before,
                                                  *g.session->zones))
      say_error(p.message());
  if (!o.why.empty()) {
    const grading::Why w = grading::why(g.session->input(), g.result, g.rubric, o.why);
    if (o.json) {
      Json j = grading::to_json(w);
      j["session"] = path;
      return print_json(j);
    }
    say_regrade(g);
    say(grading::to_text(w));
    return;
  }
  if (!o.out.empty()) write_new(o.out, json_of(g));
  if (o.json) return print_json(json_of(g));
  say_regrade(g);
  say(grading::to_text(g.result));
  if (!g.regrade) return;
  std::cout << "\n";
  say(msg("beside the sealed result"));
  say(grading::to_text(*g.comparison));
}

Number signed_number(double points) { return {points, Unit::none, 1, 0.0, true}; }

/// Several sessions as one table; below it what changed, and what cannot be graded.
class GradedMany {
 public:
  GradedMany() { table_.row({msg("old"), msg("new"), msg("change"), msg("session")}, 2); }

  void add(const std::string& file, const MarkedSession& g) {
    const std::string now = grading::verdict_name(g.result.verdict);
    Json one = {{"file", file}, {"candidate", g.session->facts.candidate}};
    if (g.comparison) {
      const grading::Comparison& c = *g.comparison;
      table_.row({cell(c.before.verdict, c.before.points, c.before.max), cell(now, c.points, c.max),
                  msg("{}", signed_number(c.points - c.before.points)), Name{file}},
                 2);
      for (const auto& d : c.criteria)
        if (std::fabs(d.difference()) >= 0.05 || !d.old_points || !d.new_points) {
          const Message one_more = msg("{} {}", d.id, signed_number(d.difference()));
          changes_.add(d.why.empty() ? msg("{}: {}", file, one_more)
                                     : msg("{}: {}: {}", file, one_more, all_of(d.why)),
                       2);
        }
      ++verdicts_[{c.before.verdict, now}];
      one.update(grading::to_json(c));
    } else {
      table_.row(
          {msg("none"), cell(now, g.result.points, g.result.max_points), Message(), Name{file}}, 2);
      one["old"] = nullptr;
      one["new"] = {{"verdict", now}, {"points", g.result.points}, {"max", g.result.max_points}};
      ++new_ones_;
    }
    list_.push_back(std::move(one));
  }
  void add(const std::string& file, const Error& e) {
    ++failed_;
    list_.push_back({{"file", file}, {"error", e.message()}});
    changes_.add(msg("cannot be graded: {}", e.message()), 2);
  }

  [[nodiscard]] int failed() const noexcept { return failed_; }
  [[nodiscard]] Json json() const {
    Json counts = Json::object();
    for (const auto& [turn, count] : verdicts_)
      counts[turn.first == turn.second ? "stay " + turn.second
                                       : fmt::format("{} -> {}", turn.first, turn.second)] = count;
    return {{"sessions", list_},
            {"graded", list_.size() - static_cast<std::size_t>(failed_)},
            {"failed", failed_},
            {"verdicts", counts}};
  }
  void say_all() const {
    say(table_);
    say(changes_);
    const auto n = static_cast<std::int64_t>(list_.size());
    List sum;
    sum.items.push_back(msgn("{} session", "{} sessions", n, n));
    for (const auto& [turn, count] : verdicts_)
      sum.items.push_back(turn.first == turn.second
                              ? msgn("{} stays {}", "{} stay {}", count, count, Term{turn.second})
                              : msg("{} {} -> {}", count, Term{turn.first}, Term{turn.second}));
    if (new_ones_ > 0) sum.items.push_back(msg("{} without a sealed result", new_ones_));
    if (failed_ > 0) sum.items.push_back(msg("{} not graded", failed_));
    say(msg("{}", sum));
  }

 private:
  static Message cell(const std::string& verdict, double points, double max) {
    return msg("{} {}/{}", Term{verdict}, as_points(points), as_number(max));
  }

  Json list_ = Json::array();
  Lines table_, changes_;
  int failed_ = 0, new_ones_ = 0;
  std::map<std::pair<std::string, std::string>, int> verdicts_;  // before and now
};

/// Returns how many could not be graded.
int run_grade_many(const std::vector<std::string>& files, const GradeArguments& o) {
  GradedMany all;
  grading::ExamContexts grounds;  // of the class
  for (const auto& file : files) {
    try {
      all.add(file, marked_session(file, o.marking, grounds));
    } catch (const Error& e) {
      all.add(file, e);
    }
  }
  if (!o.out.empty()) write_new(o.out, all.json());
  if (o.json)
    print_json(all.json());
  else
    all.say_all();
  return all.failed();
}

int run_grade(const GradeArguments& o) {
  if (o.measures) {
    std::cout << grading::measures_page();  // a page of the documentation
    return 0;
  }
  if (!o.out.empty()) {
    if (std::filesystem::exists(o.out))
      throw Error(Name{o.out}, msg("exists already, and a result is never overwritten"),
                  msg("choose another name"));
    require_writable(o.out);
  }
  const auto files = session_files(o.sessions);
  const bool many = files.size() > 1 || std::filesystem::is_directory(o.sessions.front());
  if (many || o.marking.rubric.empty())
    require_sound_marking(o.marking);  // of one session more can be said, when it is there
  if (many && !o.why.empty())
    throw Error(Name{"--why"}, msg("explains one session"), msg("name one session file"));
  if (many) return run_grade_many(files, o) > 0 ? 1 : 0;
  run_grade_one(files.front(), o);
  return 0;
}

}  // namespace

void add_grade_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<GradeArguments>();
  auto* grades = app.add_subcommand(
      "grade",
      tr("Mark recorded exams, by their own rubric or another, or by a corrected scenario"));
  auto* sessions =
      grades->add_option("session", o->sessions, tr("session files (.cavum), or folders of them"))
          ->required();
  grades->add_option("--rubric", o->marking.rubric,
                     tr("mark by this rubric (TOML) instead of the session's own"));
  grades->add_option(
      "--scenario", o->marking.scenario,
      tr("mark by this corrected scenario (TOML): its zones, and its rubric unless --rubric names one"));
  grades->add_flag("--another-task", o->marking.another_task,
                   tr("let --scenario be that of another task than the session's"));
  grades->add_option("--why", o->why,
                     tr("ticks, places and numbers behind each point that this criterion lost"));
  grades->add_option("--out", o->out,
                     tr("write the JSON to this file too, which must not exist yet"));
  grades
      ->add_flag_callback(
          "--measures",
          [o, sessions] {
            o->measures = true;
            sessions->required(false);
          },
          tr("print the table of measures that a rubric may ask for: unit, direction, range, place in the JSON"))
      ->excludes(sessions);
  grades->add_flag("--json", o->json, tr("one JSON object on standard output"));
  grades->callback([o, &exit_code] { exit_code = run_grade(*o); });
}

}  // namespace cavum::ui
