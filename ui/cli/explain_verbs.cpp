// `cavum explain`: measured data against the simulation.
#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/lab/explain/inference/explain.h"
#include "engine/lab/explain/inference/stiffness_table.h"
#include "engine/lab/explain/recording/session_recording.h"
#include "engine/lab/explain/report/laws_page.h"
#include "engine/lab/explain/report/model_file.h"
#include "engine/lab/explain/report/overview_report.h"
#include "engine/lab/explain/report/protocol.h"
#include "scenarios/exam/exam.h"
#include "ui/cli/explain_overview.h"
#include "ui/cli/explain_page.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

struct ExplainArgs {
  std::string data, rig, force, model, material, model_out, out, protocol;
  ReadingArgs reading;
  std::uint64_t seed = 1;
  std::size_t surrogates = explain::ExplainOptions{}.surrogates;
  bool json = false, laws = false, dry_run = false;
};

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
    constexpr int k_width = 40;
    const int full = k_width * percent / 100;
    std::cerr << "\r" << tr("explaining")
              << fmt::format(" [{:#<{}}{:.<{}}] {:3} %{}", "", full, "", k_width - full, percent,
                             percent == 100 ? "\n" : "")
              << std::flush;
  };
}

ForceModel load_model(const std::string& wanted) {
  const std::string path = wanted.ends_with(".toml")
                               ? wanted
                               : scenarios::find_data_file("materials", wanted + ".toml", "");
  return parse_force_model(read_text_file(path), path);
}

void write_protocol(const std::string& path) {
  if (path.starts_with("-"))
    throw Error(Name{"--protocol " + path}, msg("is no name of a file"),
                msg("write --protocol protocol.html, or --help alone"));
  const std::string csv = std::filesystem::path(path).replace_extension(".csv").string();
  if (csv == path)
    throw Error(Name{"--protocol " + path}, msg("is the name of the motion beside the page"),
                msg("use a name ending in .html"));
  require_distinct_paths({{path, path}, {csv, csv}}, {});
  write_text_file(csv, explain::protocol_motion_csv());
  write_text_file(path, protocol_html());
  say(msg("written: {} and {}", path, csv));
}

explain::Recording read_data(const ExplainArgs& a) {
  const bool session = a.data.ends_with(".cavum");
  if (!session && !a.force.empty())
    throw Error(Name{"--force"}, msg("goes with a session only"),
                msg("put the force into column f_n of the recording"));
  if (session && (!a.rig.empty() || !a.reading.empty()))
    throw Error(
        Name{a.data},
        msg("is a session, which needs no --rig, and no option that says how a table is read"),
        msg("leave them out"));
  return session ? explain::read_session_recording(a.data, a.force)
                 : explain::read_recording(a.data, a.rig, reading_options(a.reading));
}

/// What was understood, and nothing else.
void show_overview(const ExplainArgs& a, const explain::Recording& recording) {
  const explain::Overview overview = explain::overview_of(recording);
  if (!a.out.empty()) write_text_file(a.out, overview_html(recording, overview, a.data));
  if (a.json)
    print_json(to_json(overview));
  else
    say(to_text(overview));
  if (!a.json && !a.out.empty()) say(msg("written: {}", a.out));
}

/// What counts in another way than a recording does is refused; who asks for a page is told there,
/// too.
void require_conventions(const ExplainArgs& a, explain::Recording& recording) {
  try {
    for (Fact& doubt : explain::require_conventions(recording, a.data, a.reading.as_it_is))
      recording.notes.push_back(std::move(doubt));
  } catch (const Error& refused) {
    if (refused.code() != explain::ConventionError::data_fault || a.out.empty()) throw;
    explain::Explanation said;
    said.verdict = explain::Verdict::data_fault;
    said.recording = std::make_shared<const explain::Recording>(recording);
    said.notes = recording.notes;
    for (const explain::Doubt& d : explain::judge_conventions(recording).doubts)
      if (d.clear)
        said.data_faults.push_back(
            {explain::DataFault::Kind::conventions, msg("{}; give {}", d.what, d.options)});
    said.next_experiment = explain::correct_recording(said.data_faults);
    write_text_file(a.out, explanation_html(said, a.data));
    throw;
  }
}

/// What is none may have a header that such a table cannot have.
bool is_table(const std::string& text, const std::string& path) {
  try {
    return explain::is_stiffness_table(text, path);
  } catch (const Error&) {
    return false;
  }
}

/// A table of force over stiffness. False: the data are none.
bool ran_table(const ExplainArgs& a) {
  if (a.data.ends_with(".cavum")) return false;
  const std::string text = read_text_file(a.data, k_largest_table);
  if (!is_table(text, a.data)) return false;
  if (a.dry_run)
    throw Error(Name{"--dry-run"}, msg("{} is a table of means, without motion", a.data),
                msg("leave it out: a table is taken at its word"));
  if (!a.model.empty() || !a.model_out.empty())
    throw Error(Name{a.data}, msg("is a table of means, without motion"),
                msg("leave out --model and --model-out; no force model follows from it"));
  const explain::TableExplanation result =
      explain::explain_table(explain::parse_stiffness_table(text, a.data));
  if (!a.out.empty()) write_text_file(a.out, table_html(result, a.data));
  if (a.json)
    print_json(to_json(result));
  else
    say(to_text(result));
  if (!a.json && !a.out.empty()) say(msg("written: {}", a.out));
  return true;
}

void run_explain(const ExplainArgs& a) {
  if (a.laws) {
    std::cout << explain::laws_page();  // a page of the documentation
    return;
  }
  if (!a.protocol.empty()) {
    if (!a.data.empty())
      throw Error(Name{"--protocol " + a.protocol}, msg("goes without a recording"),
                  msg("leave out {}, or --protocol", a.data));
    return write_protocol(a.protocol);
  }
  if (a.data.empty())
    throw Error(msg("explain"), msg("no recording is given"),
                msg("name a CSV file, or ask for --protocol PAGE.html"));
  if (a.out.ends_with(".pdf"))
    throw Error(Name{"--out " + a.out}, msg("reports are HTML"),
                msg("use a name ending in .html, and print it from a browser"));
  const std::string rig =
      a.rig.empty() ? (std::filesystem::path(a.data).parent_path() / "rig.toml").string() : a.rig;
  require_distinct_paths(
      {{"--out " + a.out, a.out}, {"--model-out " + a.model_out, a.model_out}},
      {{"", a.data}, {"", rig}, {"", a.force}, {"", a.model.ends_with(".toml") ? a.model : ""}});
  if (!a.material.empty() && a.model.empty())
    throw Error(Name{"--material " + a.material}, msg("goes with --model only"),
                msg("name the force model, too"));
  if (ran_table(a)) return;
  explain::Recording recording = read_data(a);
  if (a.dry_run) return show_overview(a, recording);
  require_conventions(a, recording);
  explain::ExplainOptions options;
  options.seed = a.seed;
  options.surrogates = a.surrogates;
  options.progress = progress_bar();
  const ForceModel start = load_model(a.model.empty() ? "paper" : a.model);
  explain::Series added;
  if (!a.model.empty()) {
    const std::string material = a.material.empty() ? explain::material_of(start) : a.material;
    const auto owner = start.materials.find(material);
    if (owner == start.materials.end() || !(owner->second.voigt.stiffness_n_per_mm > 0.0))
      throw Error(Name{"--material " + material}, msg("is no material of {} that resists", a.model),
                  msg("name one of its materials with k_n_per_mm above 0"));
    added = explain::added_force_n(start, material, recording, a.model);
    const auto& tissue = start.materials.find(material)->second.voigt;
    recording.rig.k_n_per_mm = tissue.stiffness_n_per_mm;
    recording.rig.c_n_s_per_mm = tissue.damping_n_s_per_mm;
    options.fixed_n = &added;
  }
  const explain::Explanation result = explain::explain(recording, options);
  const bool faulty = result.verdict == explain::Verdict::data_fault,
             models = !a.model_out.empty() && !faulty;
  if (models) write_text_file(a.model_out, explain::extended_model_toml(result, start));
  if (!a.out.empty()) write_text_file(a.out, explanation_html(result, a.data));
  if (faulty && !a.model_out.empty())
    throw Error(explain::ConventionError::data_fault, Name{"--model-out " + a.model_out},
                msg("was not written: {}", List{texts_of(result.data_faults), true}),
                msg("no model can be made of a recording with faults"));
  if (a.json) {
    print_json(to_json(result));
  } else {
    say(to_text(result));
    for (const auto& path : {a.out, models ? a.model_out : ""})
      if (!path.empty()) say(msg("written: {}", path));
  }
}

}  // namespace

void add_explain_verbs(CLI::App& app, int& exit_code) {
  auto args = std::make_shared<ExplainArgs>();
  CLI::App* verb = app.add_subcommand(
      "explain", tr("what the simulation gets wrong, why, and what fixing it gains"));
  verb->add_option(
      "data", args->data,
      tr("recording (.csv) with rig.toml beside it, a session (.cavum), or a table of f_n over k_n_per_mm at v_mm_s (.csv)"));
  verb->add_option(
      "--force", args->force,
      tr("for a session: force measured beside it (.csv: t_s since the start of the exam, f_n)"));
  verb->add_option("--rig", args->rig, tr("another rig.toml"));
  add_reading_options(*verb, args->reading);
  verb->add_option(
      "--model", args->model,
      tr("force model to explain on top of: a name of data/materials, or a TOML file"));
  verb->add_option("--material", args->material,
                   tr("its material whose k and c hold for the recording (dentin)"));
  verb->add_option("--model-out", args->model_out,
                   tr("write the extended force model (.toml), for exam, rig and explain"));
  verb->add_option("--out,--html", args->out, tr("write a report (.html)"));
  verb->add_option(
          "--protocol", args->protocol,
          tr("write the recording protocol that separates all mechanisms: a page (.html) and a motion beside it (.csv)"))
      ->expected(0, 1)
      ->default_str("protocol.html");
  verb->add_flag(
      "--laws", args->laws,
      tr("print the table of laws that are looked for: equation, parameters, ranges, what shows each best"));
  verb->add_option("--seed", args->seed,
                   tr("of the surrogates; the same seed gives the same answer"))
      ->check(seed_check())
      ->capture_default_str();
  verb->add_option(
          "--surrogates", args->surrogates,
          tr("recordings in which nothing is hidden, for each step of the search; 0: none, a plain rule for comparison"))
      ->capture_default_str()
      ->check(CLI::Validator(
          [](const std::string& text) {
            int n = -1;
            return CLI::detail::lexical_cast(text, n) && (n == 0 || (n >= 99 && n <= 1000))
                       ? std::string()
                       : tr("'{}' is neither 0 nor 99 to 1000", as_is(text));
          },
          tr("0, or 99 to 1000")));
  verb->add_flag(
      "--dry-run", args->dry_run,
      tr("say what was understood of the recording, with plots in --out PAGE.html, and explain nothing"));
  verb->add_flag("--json", args->json, tr("one JSON object on standard output"));
  verb->callback([args, &exit_code] {
    run_explain(*args);
    exit_code = 0;
  });
}

}  // namespace cavum::ui
