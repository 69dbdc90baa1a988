// `cavum cohort`: a class as a whole, and a class that is simulated.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "engine/base/text.h"
#include "grading/cohort/simulated_class.h"
#include "grading/records/erasure.h"
#include "ui/cli/cohort_circuit.h"
#include "ui/cli/cohort_difficulty.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"
#include "ui/report/class_report.h"
#include "ui/report/report.h"

namespace cavum::ui {
namespace {

using nlohmann::json;

struct CohortArguments {
  cohort::SimulatedClass wanted;
  std::string folder, key, exam, marks, out;
  double borderline = 3;
  bool borderline_given = false;
  bool as_json = false;
};

SigningKey key_of(const CohortArguments& o) {
  return records::load_school_key(o.key.empty() ? records::school_key_path() : o.key);
}

void simulate(const CohortArguments& o) {
  records::Ledger ledger(o.folder, key_of(o));
  records::Identities identities(ledger.places().identities());
  const auto start = std::chrono::steady_clock::now();
  const bool shown = !o.as_json && ::isatty(STDERR_FILENO) == 1;
  const auto sat = cohort::simulate_class(o.wanted, ledger, identities, [&](int i) {
    if (shown) std::cerr << "\r" << tr("{} of {}", i, o.wanted.n) << std::flush;
  });
  if (shown) std::cerr << "\r" << std::string(20, ' ') << "\r";
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (o.as_json)
    print_json(
        json{{"sat", sat.sat}, {"filed", sat.filed}, {"seconds", seconds}, {"bytes", sat.bytes}});
  else
    say(msg("{} exams sat, {} verified and filed, {}, {} MB of sessions", sat.sat, sat.filed,
            as_s(seconds, 1), as_number(static_cast<double>(sat.bytes) * 1e-6, 1)));
}

void report(const CohortArguments& o) {
  const records::LedgerPaths places{o.folder};
  const records::LedgerContent content = records::read_ledger(places);
  if (!content.findings.empty())
    throw Error(Name{o.folder}, msg("does not hold ({})", content.findings.front().message()),
                msg("see `cavum ledger verify {}`", o.folder));
  const records::Registry registry = records::read_registry(content);
  std::vector<cohort::HumanMark> marks;
  if (!o.marks.empty()) {
    records::Identities identities(places.identities());
    records::remove_forgotten(content, identities);
    marks = cohort::parse_marks(read_text_file(o.marks), identities, o.exam, o.marks,
                                cohort::points_of_exam(registry, o.exam));
  }
  if (o.borderline_given) {
    const auto rating_is = [&](auto holds) {
      return std::any_of(marks.begin(), marks.end(),
                         [&](const cohort::HumanMark& m) { return m.rating && holds(*m.rating); });
    };
    if (!rating_is([&](double r) { return r <= o.borderline; }) ||
        !rating_is([&](double r) { return r >= o.borderline; }))
      throw Error(Name{"--borderline " + plain_number(o.borderline)},
                  msg("does not lie within the ratings that the marks give"),
                  msg("name a rating that judges used"));
  }
  const auto figures = cohort::class_figures(registry, o.exam, marks, o.borderline);
  if (!o.out.empty()) {
    report::require_report_path(o.out);
    require_distinct_paths({{"--out " + o.out, o.out}},
                           {{"", o.marks}, {"", places.database()}, {"", places.identities()}});
    const auto tooth = cohort::class_tooth(registry, places, o.exam);
    for (const auto& finding : tooth->findings)
      say_error(msg("notice: not in the pictures: {}", finding));
    if (tooth->left_out > 0)
      say_error(msg(
          "notice: not in the pictures: {} who sat it with another text, tooth or leaf size than most",
          tooth->left_out));
    write_text_file(o.out, o.out.ends_with(".pdf") ? report::class_pdf(figures, *tooth)
                                                   : report::class_html(figures, *tooth));
  }
  if (o.as_json) {
    print_json(to_json(figures));
  } else {
    say(cohort::to_text(figures));
    if (!o.out.empty()) say(msg("written: {}", o.out));
  }
}

}  // namespace

void add_cohort_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<CohortArguments>();
  auto* cohort = app.add_subcommand(
      "cohort", tr("A class as a whole: how hard, how reliable, how fair the exam was"));
  cohort->require_subcommand(1);
  auto* v = cohort->add_subcommand(
      "simulate", tr("A class of simulated students of differing skill sits an exam and is filed"));
  v->add_option("scenario", o->wanted.scenario, tr("scenario file (.toml)"))->required();
  v->add_option("--ledger", o->folder, tr("the ledger's folder"))->required();
  v->add_option("--sessions", o->wanted.sessions, tr("folder for their sessions"))->required();
  v->add_option("--n", o->wanted.n, tr("students"))
      ->check(between(1, 10000))
      ->capture_default_str();
  v->add_option("--seed", o->wanted.seed, tr("the same seed gives the same class"))
      ->capture_default_str();
  v->add_option("--at-once", o->wanted.at_once, tr("exams side by side"))
      ->check(between(1, 16))
      ->capture_default_str();
  v->add_option("--key", o->key, tr("the school's signing key (default: $CAVUM_HOME/school.key)"));
  v->add_flag("--json", o->as_json, tr("one JSON object on stdout"));
  v->callback([o, &exit_code] {
    simulate(*o);
    exit_code = 0;
  });
  v = cohort->add_subcommand("report", tr("Figures of one exam over all who sat it"));
  v->add_option("ledger", o->folder, tr("the ledger's folder"))->required();
  v->add_option("--exam", o->exam, tr("id of the scenario"))->required();
  v->add_option("--marks", o->marks, tr("people's marks, CSV `candidate,judge,points[,rating]`"));
  const auto* borderline =
      v->add_option("--borderline", o->borderline, tr("the rating that means borderline"))
          ->check(between(-1000, 1000))
          ->capture_default_str();
  v->add_option("--out", o->out, tr("also a report (.html or .pdf)"));
  v->add_flag("--json", o->as_json, tr("one JSON object on stdout"));
  v->callback([o, borderline, &exit_code] {
    o->borderline_given = borderline->count() > 0;
    report(*o);
    exit_code = 0;
  });
  add_cohort_circuit(*cohort, exit_code);
  add_cohort_difficulty(*cohort, exit_code);
}

}  // namespace cavum::ui
