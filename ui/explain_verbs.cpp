// `cavum explain`: measured data against the simulation.
#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <mutex>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/explain/explain.h"
#include "ui/print_json.h"
#include "ui/verbs.h"

namespace cavum {
namespace {

struct ExplainArgs {
  std::string data, rig;
  std::vector<std::string> columns;
  std::uint64_t seed = 1;
  std::size_t twins = explain::ExplainOptions{}.twins;
  bool json = false;
};

/// "x_mm=displacement" → {x_mm, displacement}.
explain::ColumnNames column_names(const std::vector<std::string>& given) {
  explain::ColumnNames names;
  for (const auto& pair : given) {
    const std::size_t at = pair.find('=');
    if (at == std::string::npos || at == 0 || at + 1 == pair.size())
      throw Error("--column " + pair, "is not of the form NAME=COLUMN", "write for example --column x_mm=displacement");
    names[pair.substr(0, at)] = pair.substr(at + 1);
  }
  return names;
}

/// On terminals only.
std::function<void(double)> progress_bar() {
  if (isatty(STDERR_FILENO) == 0) return {};
  auto mutex = std::make_shared<std::mutex>();
  auto shown = std::make_shared<int>(-1);
  return [mutex, shown](double part) {
    const std::lock_guard lock(*mutex);
    const int percent = static_cast<int>(100.0 * part);
    if (percent <= *shown) return;
    *shown = percent;
    std::fprintf(stderr, "\rexplaining %3d %%%s", percent, percent == 100 ? "\n" : "");
  };
}

void run_explain(const ExplainArgs& a) {
  const explain::Recording recording = explain::read_recording(a.data, a.rig, column_names(a.columns));
  explain::ExplainOptions options;
  options.seed = a.seed;
  options.twins = a.twins;
  options.progress = progress_bar();
  const explain::Explanation result = explain::explain(recording, options);
  if (a.json)
    print_json(to_json(result));
  else
    std::cout << to_text(result);
}

}  // namespace

void add_explain_verbs(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<ExplainArgs>();
  CLI::App* verb = app.add_subcommand("explain", "what the simulation gets wrong, why, and what fixing it gains");
  verb->add_option("data", args->data, "recording (.csv), with rig.toml beside it")->required();
  verb->add_option("--rig", args->rig, "another rig.toml");
  verb->add_option("--column", args->columns, "NAME=COLUMN: the file calls NAME something else; may be repeated");
  verb->add_option("--seed", args->seed, "of the twins; the same seed gives the same answer")->capture_default_str();
  verb->add_option("--twins", args->twins, "simulated twins at most, for each step of the search")->capture_default_str()->check(CLI::Range(8, 1000));
  verb->add_flag("--json", args->json, "one JSON object on standard output");
  verb->callback([args, &exit_code] {
    run_explain(*args);
    exit_code = 0;
  });
}

}  // namespace cavum
