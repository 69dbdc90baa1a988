// `cavum grade` and `cavum report`: a recorded exam, marked.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "grading/report.h"
#include "grading/result_json.h"
#include "grading/session_input.h"
#include "scenarios/parse.h"
#include "ui/print_json.h"
#include "ui/verbs.h"

namespace cavum {
namespace {

struct Options {
  std::string session, rubric, out;
  bool json = false;
};

Result result_of(const GradedSession& session, const Options& o) {
  return grade(session.input(), o.rubric.empty() ? session.rubric : parse_rubric(read_text_file(o.rubric), o.rubric));
}

void run_grade(const Options& o) {
  const auto session = load_for_grading(o.session);
  const Result result = result_of(*session, o);
  if (o.json)
    print_json(to_json(result));
  else
    std::cout << to_text(result);
}

void run_report(const Options& o) {
  if (o.out.ends_with(".pdf"))
    throw Error(o.out, "this version writes reports as HTML only", "use a name ending in .html and print it as PDF from a browser");
  const bool picture = o.out.ends_with(".svg");
  if (!picture && !o.out.ends_with(".html"))
    throw Error(o.out, "the kind of report is not clear from its name", "use a name ending in .html, or in .svg for the sections alone");
  require_writable(o.out);
  const auto session = load_for_grading(o.session);
  const Result result = result_of(*session, o);
  write_text_file(o.out, picture ? sections_svg(result, session->input()) : report_html(result, session->input(), session->facts));
  std::cout << "written: " << o.out << " (" << verdict_name(result.verdict) << ")\n";
}

}  // namespace

void add_grade_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<Options>();
  auto* grades = app.add_subcommand("grade", "Mark a recorded exam");
  grades->add_option("session", o->session, "session file (.cavum)")->required();
  grades->add_option("--rubric", o->rubric, "mark by this rubric (TOML) instead of the session's own");
  grades->add_flag("--json", o->json, "one JSON object on standard output");
  grades->callback([o, &exit_code] {
    run_grade(*o);
    exit_code = 0;
  });

  auto* reports = app.add_subcommand("report", "Write the report of a recorded exam, or its sections as a picture");
  reports->add_option("session", o->session, "session file (.cavum)")->required();
  reports->add_option("--out", o->out, "file to write: .html for the report, .svg for the three sections")->required();
  reports->add_option("--rubric", o->rubric, "mark by this rubric (TOML) instead of the session's own");
  reports->callback([o, &exit_code] {
    run_report(*o);
    exit_code = 0;
  });
}

}  // namespace cavum
