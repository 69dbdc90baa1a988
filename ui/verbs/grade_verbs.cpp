// `cavum grade`: recorded exams, marked.
#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/kept.h"
#include "engine/base/text.h"
#include "engine/language/shown.h"
#include "grading/result/compare.h"
#include "grading/result/result_json.h"
#include "grading/words/measures_page.h"
#include "grading/words/why.h"
#include "scenarios/review/advice.h"
#include "ui/parts/print_json.h"
#include "ui/verbs/marked_session.h"
#include "ui/verbs/session_files.h"
#include "ui/verbs/verbs.h"

namespace cavum::ui {
namespace {

using Json = nlohmann::ordered_json;

struct GradeArguments {
  std::vector<std::string> sessions;
  std::string why, out;
  MarkingOptions marking;
  bool json = false, measures = false;
};

/// The result with its contract names, and beside it the old one where another rubric or scenario was asked for.
Json json_of(const MarkedSession& g) {
  Json j = grading::to_json(g.result);
  if (g.regrade) j["regrade"] = grading::to_json(*g.comparison);
  return j;
}

void write_new(const std::string& path, const Json& json) {
  write_text_file(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", {.may_replace = false});
}

void run_grade_one(const std::string& path, const GradeArguments& o) {
  grading::ExamGrounds grounds;
  const MarkedSession g = marked_session(path, o.marking, grounds);
  if (!o.marking.rubric.empty())
    for (const auto& p : scenarios::advise_rubric(g.session->scenario, g.rubric, *g.session->before, *g.session->zones))
      std::cerr << "cavum: " << one_line(english_text(p.message())) << "\n";
  if (!o.why.empty()) {
    const grading::Why w = grading::why(g.session->input(), g.result, g.rubric, o.why);
    if (o.json) {
      Json j = grading::to_json(w);
      j["session"] = path;
      return print_json(j);
    }
    if (g.regrade) std::cout << "REGRADE: " << grading::regrade_text(*g.comparison) << "\n\n";
    std::cout << grading::to_text(w);
    return;
  }
  if (!o.out.empty()) write_new(o.out, json_of(g));
  if (o.json) return print_json(json_of(g));
  if (g.regrade) std::cout << "REGRADE: " << grading::regrade_text(*g.comparison) << "\n\n";
  std::cout << grading::to_text(g.result);
  if (g.regrade) std::cout << "\nbeside the sealed result\n" << grading::to_text(*g.comparison);
}

/// Several sessions as one table; a session that cannot be graded is a row of its own. Returns how many could not.
int run_grade_many(const std::vector<std::string>& files, const GradeArguments& o) {
  Json list = Json::array();
  std::string table = "  old               new               change  session\n";
  int failed = 0, compared = 0;
  std::map<std::string, int> verdicts;  // "fail -> pass"
  const auto cell = [](const std::string& verdict, double points, double max) {
    std::string s = fmt::format("{} {}/{}", verdict, fixed(points, 1), plain_number(max));
    s.resize(std::max<std::size_t>(18, s.size() + 1), ' ');
    return s;
  };
  grading::ExamGrounds grounds;  // of the class
  for (const auto& file : files) {
    try {
      const MarkedSession g = marked_session(file, o.marking, grounds);
      const std::string now = grading::verdict_name(g.result.verdict);
      Json one = {{"file", file}, {"candidate", g.session->facts.candidate}};
      if (g.comparison) {
        const grading::Comparison& c = *g.comparison;
        std::string change = grading::signed_points(c.points - c.before.points);
        change.resize(std::max<std::size_t>(8, change.size() + 1), ' ');
        table +=
            fmt::format("  {}{}{}{}\n", cell(c.before.verdict, c.before.points, c.before.max), cell(now, c.points, c.max), change, one_line(file));
        for (const auto& d : c.criteria)
          if (std::fabs(d.difference()) >= 0.05 || !d.old_points || !d.new_points) {
            std::string line = fmt::format("      {} {}", kept(d.id), grading::signed_points(d.difference()));
            for (std::size_t i = 0; i < d.why.size(); ++i) line += (i > 0 ? "; " : ": ") + d.why[i];
            table += line + "\n";
          }
        ++compared;
        ++verdicts[c.before.verdict == now ? "stay " + now : fmt::format("{} -> {}", c.before.verdict, now)];
        const Json json = grading::to_json(c);
        for (const auto& [key, value] : json.items()) one[key] = value;
      } else {
        table += fmt::format("  {}{}        {}\n", cell("none", 0, 0), cell(now, g.result.points, g.result.max_points), one_line(file));
        one["old"] = nullptr;
        one["new"] = {{"verdict", now}, {"points", g.result.points}, {"max", g.result.max_points}};
      }
      list.push_back(std::move(one));
    } catch (const Error& e) {
      ++failed;
      list.push_back({{"file", file}, {"error", e.what()}});
      table += fmt::format("  cannot be graded: {}\n", one_line(e.what()));
    }
  }
  const Json all = {{"sessions", list}, {"graded", files.size() - static_cast<std::size_t>(failed)}, {"failed", failed}, {"verdicts", verdicts}};
  if (!o.out.empty()) write_new(o.out, all);
  if (o.json) {
    print_json(all);
  } else {
    std::cout << table << files.size() << (files.size() == 1 ? " session" : " sessions");
    for (const auto& [what, count] : verdicts) std::cout << ", " << count << " " << what;
    if (const int new_ones = static_cast<int>(files.size()) - failed - compared; new_ones > 0)
      std::cout << ", " << new_ones << " without a sealed result";
    if (failed > 0) std::cout << ", " << failed << " not graded";
    std::cout << "\n";
  }
  return failed;
}

int run_grade(const GradeArguments& o) {
  if (o.measures) {
    std::cout << grading::measures_page();
    return 0;
  }
  if (!o.out.empty()) {
    if (std::filesystem::exists(o.out)) throw Error(o.out, msg("exists already, and a result is never overwritten"), msg("choose another name"));
    require_writable(o.out);
  }
  const auto files = session_files(o.sessions);
  const bool many = files.size() > 1 || std::filesystem::is_directory(o.sessions.front());
  if (many || o.marking.rubric.empty()) require_sound_marking(o.marking);  // of one session more can be said, when it is there
  if (many && !o.why.empty()) throw Error("--why", msg("explains one session"), msg("name one session file"));
  if (many) return run_grade_many(files, o) > 0 ? 1 : 0;
  run_grade_one(files.front(), o);
  return 0;
}

}  // namespace

void add_grade_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<GradeArguments>();
  auto* grades = app.add_subcommand("grade", "Mark recorded exams, by their own rubric or another, or by a corrected scenario");
  auto* sessions = grades->add_option("session", o->sessions, "session files (.cavum), or folders of them")->required();
  grades->add_option("--rubric", o->marking.rubric, "mark by this rubric (TOML) instead of the session's own");
  grades->add_option("--scenario", o->marking.scenario,
                     "mark by this corrected scenario (TOML): its zones, and its rubric unless --rubric names one");
  grades->add_flag("--another-task", o->marking.another_task, "let --scenario be that of another task than the session's");
  grades->add_option("--why", o->why, "ticks, places and numbers behind each point that this criterion lost");
  grades->add_option("--out", o->out, "write the JSON to this file too, which must not exist yet");
  grades
      ->add_flag_callback(
          "--measures",
          [o, sessions] {
            o->measures = true;
            sessions->required(false);
          },
          "print the table of measures that a rubric may ask for: unit, direction, range, place in the JSON")
      ->excludes(sessions);
  grades->add_flag("--json", o->json, "one JSON object on standard output");
  grades->callback([o, &exit_code] { exit_code = run_grade(*o); });
}

}  // namespace cavum::ui
