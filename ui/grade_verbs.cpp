// `cavum grade` and `cavum report`: a recorded exam, marked.
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/text.h"
#include "grading/compare.h"
#include "grading/report.h"
#include "grading/result_json.h"
#include "grading/session_input.h"
#include "grading/why.h"
#include "scenarios/parse.h"
#include "scenarios/rubric_check.h"
#include "ui/print_json.h"
#include "ui/session_files.h"
#include "ui/verbs.h"

namespace cavum {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::vector<std::string> sessions;
  std::string rubric, scenario, why, out;
  bool json = false, another_task = false, overwrite = false;
  [[nodiscard]] bool anew() const { return !rubric.empty() || !scenario.empty(); }
};

/// A session marked as asked, and beside it what it was sealed with.
struct Graded {
  std::unique_ptr<GradedSession> session;
  RubricSpec rubric;
  Result result;
  std::optional<Comparison> comparison;
  bool regrade = false;  ///< the result is not the sealed one, which stands in `comparison`
};

Graded graded(const std::string& path, const Options& o) {
  Graded g;
  g.session = load_for_grading(path);
  GradedSession& s = *g.session;
  const auto old = read_old_result(s.sealed_result_json);
  const RubricSpec old_rubric = s.rubric;
  std::optional<Result> again;
  if (o.anew() && old) again = grade(s.input(), old_rubric);
  if (!o.scenario.empty()) use_scenario(s, load_scenario(o.scenario), o.another_task);
  if (!o.rubric.empty())
    use_rubric(s, parse_rubric(read_text_file(o.rubric), o.rubric));
  else if (!o.scenario.empty())
    use_rubric(s, s.scenario.rubric);
  g.rubric = s.rubric;
  if (again && o.scenario.empty()) {
    g.result = *again;
    mark(g.result, g.rubric);
  } else {
    g.result = grade(s.input(), g.rubric);
  }
  if (!old) return g;
  g.comparison = compare(*old, again ? *again : g.result, old_rubric, g.result, g.rubric);
  g.comparison->by = o.rubric.empty() ? "" : "the rubric " + o.rubric;
  if (!o.scenario.empty()) g.comparison->by += (o.rubric.empty() ? "" : " and ") + ("the scenario " + o.scenario);
  if (!o.anew()) g.comparison->by = "this version of the program";
  g.regrade = o.anew() || g.comparison->differs();
  return g;
}

/// The result with its contract names, and beside it the old one where another rubric or scenario was asked for.
Json json_of(const Graded& g) {
  Json j = to_json(g.result);
  if (g.regrade) j["regrade"] = to_json(*g.comparison);
  return j;
}

/// A mistake in what is to be marked by is found before any session is opened; what is unwise is said on the side.
void require_sound_marking(const Options& o) {
  const auto warn = [](const RubricSpec& rubric) {
    for (const auto& p : turned_round(rubric)) std::cerr << "cavum: " << one_line(p.text()) << "\n";
  };
  if (!o.rubric.empty()) warn(parse_rubric(read_text_file(o.rubric), o.rubric));
  if (o.scenario.empty()) return;
  const Scenario s = load_scenario(o.scenario);
  if (o.rubric.empty()) warn(s.rubric);
}

void write_new(const std::string& path, const Json& json) {
  if (std::filesystem::exists(path)) throw Error(path, "exists already, and a result is never overwritten", "choose another name");
  write_text_file(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void run_grade_one(const std::string& path, const Options& o) {
  const Graded g = graded(path, o);
  if (!o.why.empty()) {
    const Why w = why(g.session->input(), g.result, g.rubric, o.why);
    if (o.json) {
      Json j = to_json(w);
      j["session"] = path;
      return print_json(j);
    }
    if (g.regrade) std::cout << "REGRADE: " << regrade_text(*g.comparison) << "\n\n";
    std::cout << to_text(w);
    return;
  }
  if (!o.out.empty()) write_new(o.out, json_of(g));
  if (o.json) return print_json(json_of(g));
  if (g.regrade) std::cout << "REGRADE: " << regrade_text(*g.comparison) << "\n\n";
  std::cout << to_text(g.result);
  if (g.regrade) std::cout << "\nbeside the sealed result\n" << to_text(*g.comparison);
}

/// Several sessions as one table; a session that cannot be graded is a row of its own. Returns how many could not.
int run_grade_many(const std::vector<std::string>& files, const Options& o) {
  Json list = Json::array();
  std::string table = "  old               new               change  session\n";
  int failed = 0, compared = 0;
  std::map<std::string, int> verdicts;  // "fail -> pass"
  const auto cell = [](const std::string& verdict, double points, double max) {
    std::string s = verdict + " " + fixed(points, 1) + "/" + plain_number(max);
    s.resize(std::max<std::size_t>(18, s.size() + 1), ' ');
    return s;
  };
  for (const auto& file : files) {
    try {
      const Graded g = graded(file, o);
      const std::string now = verdict_name(g.result.verdict);
      Json one = {{"file", file}, {"candidate", g.session->facts.candidate}};
      if (g.comparison) {
        const Comparison& c = *g.comparison;
        std::string change = signed_points(c.points - c.before.points);
        change.resize(std::max<std::size_t>(8, change.size() + 1), ' ');
        table += "  " + cell(c.before.verdict, c.before.points, c.before.max) + cell(now, c.points, c.max) + change + one_line(file) + "\n";
        for (const auto& d : c.criteria)
          if (std::fabs(d.difference()) >= 0.05 || !d.old_points || !d.new_points) {
            std::string line = "      " + d.id + " " + signed_points(d.difference());
            for (std::size_t i = 0; i < d.why.size(); ++i) line += (i > 0 ? "; " : ": ") + d.why[i];
            table += line + "\n";
          }
        ++compared;
        ++verdicts[c.before.verdict == now ? "stay " + now : c.before.verdict + " -> " + now];
        const Json json = to_json(c);
        for (const auto& [key, value] : json.items()) one[key] = value;
      } else {
        table += "  " + cell("none", 0, 0) + cell(now, g.result.points, g.result.max_points) + "        " + one_line(file) + "\n";
        one["old"] = nullptr;
        one["new"] = {{"verdict", now}, {"points", g.result.points}, {"max", g.result.max_points}};
      }
      list.push_back(std::move(one));
    } catch (const Error& e) {
      ++failed;
      list.push_back({{"file", file}, {"error", e.what()}});
      table += "  cannot be graded: " + one_line(e.what()) + "\n";
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

int run_grade(const Options& o) {
  if (!o.out.empty()) {
    if (std::filesystem::exists(o.out)) throw Error(o.out, "exists already, and a result is never overwritten", "choose another name");
    require_writable(o.out);
  }
  require_sound_marking(o);
  const auto files = session_files(o.sessions);
  const bool many = files.size() > 1 || std::filesystem::is_directory(o.sessions.front());
  if (many && !o.why.empty()) throw Error("--why", "explains one session", "name one session file");
  if (many) return run_grade_many(files, o) > 0 ? 1 : 0;
  run_grade_one(files.front(), o);
  return 0;
}

/// An earlier report may be written anew, any other file not.
void require_report_place(const Options& o) {
  require_writable(o.out);
  if (!std::filesystem::exists(o.out) || std::filesystem::file_size(o.out) == 0 || o.overwrite) return;
  const std::string text = read_text_file(o.out), head = text.substr(0, 200);
  const bool report = o.out.ends_with(".svg") ? head.starts_with("<svg") : head.starts_with("<!doctype html>");
  if (!report || text.find(o.out.ends_with(".svg") ? "of the target removed" : "grading/README.md of Cavum") == std::string::npos)
    throw Error(o.out, "exists already and is no report of Cavum", "choose another name, or overwrite it with --overwrite");
}

void run_report(const Options& o) {
  if (o.out.ends_with(".pdf"))
    throw Error(o.out, "this version writes reports as HTML only", "use a name ending in .html and print it as PDF from a browser");
  const bool picture = o.out.ends_with(".svg");
  if (!picture && !o.out.ends_with(".html"))
    throw Error(o.out, "the kind of report is not clear from its name", "use a name ending in .html, or in .svg for the sections alone");
  require_report_place(o);
  require_sound_marking(o);
  const Graded g = graded(o.sessions.front(), o);
  const GradeInput input = g.session->input();
  write_text_file(o.out,
                  picture ? sections_svg(g.result, input) : report_html(g.result, input, g.session->facts, g.regrade ? &*g.comparison : nullptr));
  std::cout << "written: " << o.out << " (" << verdict_name(g.result.verdict) << ")\n";
}

}  // namespace

void add_grade_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<Options>();
  auto* grades = app.add_subcommand("grade", "Mark recorded exams, by their own rubric or another, or by a corrected scenario");
  grades->add_option("session", o->sessions, "session files (.cavum), or folders of them")->required();
  grades->add_option("--rubric", o->rubric, "mark by this rubric (TOML) instead of the session's own");
  grades->add_option("--scenario", o->scenario, "mark by this corrected scenario (TOML): its zones, and its rubric unless --rubric names one");
  grades->add_flag("--another-task", o->another_task, "let --scenario be that of another task than the session's");
  grades->add_option("--why", o->why, "ticks, places and numbers behind each point that this criterion lost");
  grades->add_option("--out", o->out, "write the JSON to this file too, which must not exist yet");
  grades->add_flag("--json", o->json, "one JSON object on standard output");
  grades->callback([o, &exit_code] { exit_code = run_grade(*o); });

  const auto r = std::make_shared<Options>();
  auto* reports = app.add_subcommand("report", "Write the report of a recorded exam, or its sections as a picture");
  reports->add_option("session", r->sessions, "session file (.cavum)")->required()->expected(1);
  reports->add_option("--out", r->out, "file to write: .html for the report, .svg for the three sections")->required();
  reports->add_option("--rubric", r->rubric, "mark by this rubric (TOML) instead of the session's own");
  reports->add_option("--scenario", r->scenario, "mark by this corrected scenario (TOML)");
  reports->add_flag("--another-task", r->another_task, "let --scenario be that of another task than the session's");
  reports->add_flag("--overwrite", r->overwrite, "write over a file that is no report");
  reports->callback([r, &exit_code] {
    run_report(*r);
    exit_code = 0;
  });
}

}  // namespace cavum
