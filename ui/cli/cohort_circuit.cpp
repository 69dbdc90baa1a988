#include "ui/cli/cohort_circuit.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <memory>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "grading/cohort/circuit.h"
#include "grading/records/erasure.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

struct CircuitArguments {
  std::string folder, out;
  std::vector<std::string> exams, marks;
  bool as_json = false;
};

/// `EXAM=FILE`, for an exam of the circuit.
std::pair<std::string, std::string> marks_file(const CircuitArguments& o,
                                               const std::string& given) {
  const auto at = given.find('=');
  const std::string exam = given.substr(0, at);
  if (at == std::string::npos || at + 1 == given.size())
    throw Error(Name{"--marks " + given}, msg("does not say which exam's marks these are"),
                msg("write --marks EXAM=FILE"));
  if (std::find(o.exams.begin(), o.exams.end(), exam) == o.exams.end())
    throw Error(Name{"--marks " + given}, msg("is of no exam of the circuit"),
                msg("name it with --exams, too"));
  return {exam, given.substr(at + 1)};
}

void measure_circuit(const CircuitArguments& o) {
  const records::LedgerPaths places{o.folder};
  const records::LedgerContent content = records::read_ledger(places);
  if (!content.findings.empty())
    throw Error(Name{o.folder}, msg("does not hold ({})", content.findings.front().message()),
                msg("see `cavum ledger verify {}`", o.folder));
  const records::Registry registry = records::read_registry(content);
  records::Identities identities(places.identities());
  records::remove_forgotten(content, identities);
  std::map<std::string, std::vector<cohort::HumanMark>> marks;
  std::vector<NamedFile> kept{{"", places.database()}, {"", places.identities()}};
  for (const auto& given : o.marks) {
    const auto [exam, file] = marks_file(o, given);
    if (!marks.try_emplace(exam).second)
      throw Error(Name{"--marks " + given}, msg("gives marks of an exam twice"),
                  msg("put them into one file"));
    marks[exam] = cohort::parse_marks(read_text_file(file), identities, exam, file,
                                      cohort::points_of_exam(registry, exam));
    kept.push_back({"", file});
  }
  if (!o.out.empty()) {
    if (!o.out.ends_with(".csv"))
      throw Error(Name{"--out " + o.out}, msg("is no table"), msg("use a name ending in .csv"));
    require_distinct_paths({{"--out " + o.out, o.out}}, kept);
  }
  const cohort::CircuitFigures figures =
      cohort::circuit_figures(registry, identities, o.exams, marks);
  if (!o.out.empty()) write_text_file(o.out, roster_csv(figures));
  if (o.as_json) {
    print_json(to_json(figures));
  } else {
    say(to_text(figures));
    if (!o.out.empty()) say(msg("written: {}", o.out));
  }
}

}  // namespace

void add_cohort_circuit(CLI::App& cohort, int& exit_code) {
  const auto o = std::make_shared<CircuitArguments>();
  auto* v = cohort.add_subcommand(
      "circuit",
      tr("Several exams of one class: how dependable they are together, and which station or judge is severe"));
  v->add_option("ledger", o->folder, tr("the ledger's folder"))->required();
  v->add_option("--exams", o->exams, tr("ids of the scenarios, two at least: a,b,c"))
      ->required()
      ->delimiter(',');
  v->add_option("--marks", o->marks,
                tr("people's marks of one exam: EXAM=FILE, CSV `candidate,judge,points`"));
  v->add_option("--out", o->out,
                tr("also a table of the candidates, raw and adjusted marks (.csv)"));
  v->add_flag("--json", o->as_json, tr("one JSON object on stdout"));
  v->callback([o, &exit_code] {
    measure_circuit(*o);
    exit_code = 0;
  });
}

}  // namespace cavum::ui
