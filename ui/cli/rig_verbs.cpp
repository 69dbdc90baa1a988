// `cavum rig`: the paper's experiments on a virtual testing machine, the closed-loop press, and the
// servo in real time.
#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/lab/rig/cube_rig.h"
#include "engine/lab/rig/grind_rig.h"
#include "engine/lab/rig/press_rig.h"
#include "engine/lab/rig/record_rig.h"
#include "engine/lab/rig/servo_rig.h"
#include "engine/lab/rig/tooth_rig.h"
#include "scenarios/exam/exam.h"
#include "ui/cli/rig_pictures.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

namespace fs = std::filesystem;

struct Common {
  std::string out, bur = "round-1.0";
  int runs = 20;
  std::uint64_t seed = 1;
  bool json = false;
};

struct CubeArgs : Common {
  std::vector<std::string> models;
  std::string csv;
  CubeOptions options;
  double csv_k_n_per_mm = k_paper_k_n_per_mm;
};

struct ToothArgs : Common {
  std::string tooth, model = "paper";
  std::vector<double> at_mm;
  ToothRigOptions options;
};

struct PressArgs : Common {
  std::string model;
  std::vector<std::string> damping;
  std::vector<double> hand_n_per_m;
  PressOptions options;
  bool cells = false;
};

struct GrindArgs {
  std::string model = "clinical", bur = "cylinder-flat-1.0";
  bool json = false;
  GrindOptions options;
};

struct ServoArgs {
  std::string out, bur = "round-1.0", model = "consistent";
  double tick_ms = 1000 * k_tick_s;
  bool json = false;
  ServoRigOptions options;
};

struct RecordArgs {
  std::string motion, model = "consistent", bur = "round-1.0", csv;
  RecordOptions options;
};

/// A name in a folder of data/, or a TOML file.
std::string data_path(const std::string& folder, const std::string& wanted) {
  return wanted.ends_with(".toml") ? wanted
                                   : scenarios::find_data_file(folder, wanted + ".toml", "");
}

Bur load_bur(const std::string& wanted) {
  const std::string path = data_path("burs", wanted);
  return parse_bur(read_text_file(path), path);
}

ForceModel load_model(const std::string& wanted) {
  const std::string path = data_path("materials", wanted);
  return parse_force_model(read_text_file(path), path);
}

/// What would spoil the end is said before the work begins.
void require_picture(const std::string& path) {
  if (path.empty()) return;
  if (!path.ends_with(".svg"))
    throw Error(Name{"--out " + path}, msg("the rigs draw SVG only"),
                msg("use a name ending in .svg"));
  require_writable(path);
}

void add_common(CLI::App& verb, Common& a, bool runs) {
  verb.add_option("--out", a.out, tr("picture to write (.svg)"));
  verb.add_option("--bur", a.bur, tr("bur: a name of data/burs, or a TOML file"))
      ->capture_default_str();
  if (runs) {
    verb.add_option(
            "--runs", a.runs,
            tr("of each kind, each with an offset, an encoder phase and a noise of its own"))
        ->capture_default_str()
        ->check(between(1, 1000));
    verb.add_option("--seed", a.seed, tr("of all that differs between runs"))
        ->check(seed_check())
        ->capture_default_str();
  }
  verb.add_flag("--json", a.json, tr("one JSON object on standard output"));
}

template <class Result, class Text>
void finish(const Common& a, const Result& result, const std::string& svg, const Text& text) {
  if (!a.out.empty()) write_text_file(a.out, svg);
  if (a.json)
    print_json(to_json(result));
  else
    say(text());
  if (!a.json && !a.out.empty()) say(msg("written: {}", a.out));
}

void run_cube(CubeArgs a) {
  require_picture(a.out);
  const std::string rig_toml = (fs::path(a.csv).parent_path() / "rig.toml").string();
  if (!a.csv.empty()) {
    require_distinct_paths({{"--csv " + a.csv, a.csv}, {rig_toml, rig_toml}}, {{"", a.bur}});
    require_rigs_own(rig_toml);
    if (fs::path(a.csv).filename() == "rig.toml")
      throw Error(Name{"--csv " + a.csv}, msg("is the name of the description beside it"),
                  msg("use a name ending in .csv"));
    bool there = false;
    for (const double k : a.options.k_n_per_mm)
      there = there || std::fabs(k - a.csv_k_n_per_mm) < 1e-9;
    if (!there)
      throw Error(Name{"--csv-k"}, msg("this stiffness is not among --k"),
                  msg("name one of the k that are tested"));
    a.options.recorded_k_n_per_mm = a.csv_k_n_per_mm;
  }
  std::vector<CubeModel> models;
  for (const auto& name : a.models)
    models.push_back(
        {name.ends_with(".toml") ? fs::path(name).stem().string() : name, load_model(name)});
  a.options.runs = a.runs;
  a.options.seed = a.seed;
  const CubeResult result = run_cube_rig(models, load_bur(a.bur), a.options);
  if (!a.csv.empty()) {
    write_text_file(a.csv, recordings_csv(result));
    write_text_file(rig_toml, recordings_rig_toml(result));
  }
  finish(a, result, cube_svg(result), [&] { return to_text(result); });
  if (!a.json && !a.csv.empty()) say(msg("written: {} and {}", a.csv, rig_toml));
}

void run_tooth(ToothArgs a) {
  require_picture(a.out);
  if (!a.at_mm.empty()) a.options.at_mm = {a.at_mm[0], a.at_mm[1]};
  a.options.runs = a.runs;
  a.options.seed = a.seed;
  const Tooth tooth = load_tooth_file(
      a.tooth.empty() ? scenarios::find_data_file("teeth", "lower_molar.cvt", "") : a.tooth);
  const ToothRigResult result =
      run_tooth_rig(tooth, load_model(a.model), load_bur(a.bur), a.options);
  finish(a, result, tooth_svg(result), [&] { return to_text(result); });
}

DampingRule parse_damping(const std::string& name) {
  for (const DampingRule rule : {DampingRule::paper, DampingRule::consistent, DampingRule::none})
    if (name == damping_name(rule)) return rule;
  throw Error(Name{"--c"}, msg("there is no damping '{}'", name),
              msg("use paper, consistent or none"));
}

bool run_press(PressArgs a) {
  require_picture(a.out);
  if (!a.model.empty()) a.options.rendering = load_model(a.model).rendering;
  if (!a.damping.empty()) {
    a.options.damping.clear();
    for (const auto& name : a.damping) a.options.damping.push_back(parse_damping(name));
  }
  if (!a.hand_n_per_m.empty()) {
    a.options.hand_n_per_mm.clear();
    for (const double k : a.hand_n_per_m) a.options.hand_n_per_mm.push_back(k / 1000.0);
  }
  const PressResult result = run_press_rig(a.options, load_bur(a.bur));
  finish(a, result, press_svg(result), [&] { return to_text(result, a.cells); });
  return result.within_limits();
}

void run_grind(const GrindArgs& a) {
  const GrindResult result = run_grind_rig(load_model(a.model), load_bur(a.bur), a.options);
  if (a.json)
    print_json(to_json(result));
  else
    say(to_text(result));
}

bool run_servo(const ServoArgs& a) {
  require_writable(a.out);
  const std::string bur = data_path("burs", a.bur), model = data_path("materials", a.model);
  static_cast<void>(load_bur(a.bur));  // their mistakes are named with their files
  static_cast<void>(load_model(a.model));
  const ServoRigResult result =
      run_servo_rig(servo_rig_setup(read_text_file(bur), read_text_file(model), a.tick_ms / 1000),
                    a.out, a.options);
  if (a.json) {
    print_json(to_json(result));
  } else {
    say(to_text(result));
    say(msg("recorded: {}", a.out));
  }
  return result.on_time();
}

void run_record(const RecordArgs& a) {
  const std::string rig_toml = (fs::path(a.csv).parent_path() / "rig.toml").string();
  if (fs::path(a.csv).filename() == "rig.toml")
    throw Error(Name{"--csv " + a.csv}, msg("is the name of the description beside it"),
                msg("use a name ending in .csv"));
  require_distinct_paths({{"--csv " + a.csv, a.csv}, {rig_toml, rig_toml}},
                         {{"", a.motion}, {"", a.model}, {"", a.bur}});
  require_rigs_own(rig_toml);
  const Motion motion = parse_motion(read_text_file(a.motion, k_largest_table), a.motion);
  const RecordResult result =
      run_record_rig(motion, load_model(a.model), load_bur(a.bur), a.options);
  write_text_file(a.csv, record_csv(result));
  write_text_file(rig_toml, record_rig_toml(result));
  const auto sessions = static_cast<std::int64_t>(a.options.sessions);
  say(msgn("{} session, {} rows", "{} sessions, {} rows", sessions, sessions, result.rows.size()));
  say(msg("written: {} and {}", a.csv, rig_toml));
}

void add_cube(CLI::App& rig, int& exit_code) {
  auto* verb = rig.add_subcommand(
      "cube", tr("Cutting force of cubes over their stiffness (the paper's Fig. 6 and eq. 6)"));
  const auto a = std::make_shared<CubeArgs>();
  a->models = {"paper", "consistent"};
  add_common(*verb, *a, true);
  verb->add_option("--model", a->models,
                   tr("force models: paper, consistent, or TOML files; each keeps its ratio c/√k"))
      ->delimiter(',')
      ->capture_default_str();
  verb->add_option("--k", a->options.k_n_per_mm, tr("stiffnesses, N/mm"))
      ->delimiter(',')
      ->check(between(0.0, 2.0))
      ->capture_default_str();
  verb->add_option(
      "--csv", a->csv,
      tr("recordings of the first model at --csv-k; rig.toml with their units is written beside it"));
  verb->add_option("--csv-k", a->csv_k_n_per_mm, tr("stiffness that is recorded, N/mm"))
      ->check(between(0.0, 2.0))
      ->capture_default_str();
  verb->callback([a, &exit_code] {
    run_cube(*a);
    exit_code = 0;
  });
}

void add_tooth(CLI::App& rig, int& exit_code) {
  auto* verb = rig.add_subcommand(
      "tooth", tr("Force over time through hard tissue into the pulp (the paper's Fig. 9)"));
  const auto a = std::make_shared<ToothArgs>();
  a->runs = 30;
  add_common(*verb, *a, true);
  verb->add_option("--tooth", a->tooth, tr("tooth file (.cvt) instead of the shipped molar"));
  verb->add_option("--model", a->model, tr("force model: paper, consistent, or a TOML file"))
      ->capture_default_str();
  verb->add_option("--at", a->at_mm,
                   tr("x,y of the middle, mm, instead of the middle of the pulp's roof"))
      ->delimiter(',')
      ->expected(2);
  verb->add_option("--spread-mm", a->options.spread_mm,
                   tr("runs lie at most this far from the middle"))
      ->check(between(0.0, 5.0))
      ->capture_default_str();
  verb->callback([a, &exit_code] {
    run_tooth(*a);
    exit_code = 0;
  });
}

void add_press(CLI::App& rig, int& exit_code) {
  auto* verb = rig.add_subcommand(
      "press",
      tr("Is the rendered force stable in a hand? Closed loop on the simulated Omni. Exit 1 when a limit is missed"));
  const auto a = std::make_shared<PressArgs>();
  PressOptions& o = a->options;
  add_common(*verb, *a, false);
  verb->add_option(
      "--model", a->model,
      tr("take the rendering's constants from this force model: paper, consistent, or a TOML file"));
  verb->add_option("--k", o.k_n_per_mm, tr("stiffnesses, N/mm"))
      ->delimiter(',')
      ->check(between(0.05, 5.0))
      ->capture_default_str();
  verb->add_option("--c", a->damping,
                   tr("dampings: paper (2√k), consistent (critical damping of the stylus), none"))
      ->delimiter(',');
  verb->add_option("--delay", o.delay_ticks, tr("ticks from command to force"))
      ->delimiter(',')
      ->check(between(0, 3))
      ->capture_default_str();
  verb->add_option("--hand", a->hand_n_per_m, tr("stiffnesses of the hand, N/m"))
      ->delimiter(',')
      ->check(between(10.0, 10000.0));
  verb->add_option("--press", o.press_n, tr("loads, N"))
      ->delimiter(',')
      ->check(between(0.05, 3.0))
      ->capture_default_str();
  verb->add_option("--speed", o.contact_mm_s, tr("speeds at which contact is made, mm/s"))
      ->delimiter(',')
      ->check(between(0.5, 500.0))
      ->capture_default_str();
  verb->add_option("--hold-s", o.hold_s, tr("how long the press is held"))
      ->check(between(0.5, 120.0))
      ->capture_default_str();
  verb->add_option("--hand-mass-kg", o.hand_mass_kg, tr("of the fingers"))
      ->check(between(0.001, 2.0))
      ->capture_default_str();
  verb->add_option("--hand-damping", o.hand_damping_ratio, tr("damping ratio of the hand"))
      ->check(between(0.0, 5.0))
      ->capture_default_str();
  verb->add_flag("--cells", a->cells, tr("a line for every press and contact"));
  verb->callback([a, &exit_code] { exit_code = run_press(*a) ? 0 : 1; });
}

void add_grind(CLI::App& rig, int& exit_code) {
  auto* verb = rig.add_subcommand(
      "grind",
      tr("How fast a bur under a constant load removes each tissue, and how fast it turns meanwhile"));
  const auto a = std::make_shared<GrindArgs>();
  GrindOptions& o = a->options;
  verb->add_option("--model", a->model,
                   tr("force model: paper, consistent, clinical, or a TOML file"))
      ->capture_default_str();
  verb->add_option("--bur", a->bur, tr("bur: a name of data/burs, or a TOML file"))
      ->capture_default_str();
  verb->add_option("--load-n", o.load_n, tr("loads, N"))
      ->delimiter(',')
      ->check(between(0.05, 10.0))
      ->capture_default_str();
  verb->add_option("--rpm", o.rpm, tr("free speed of the handpiece"))
      ->check(between(1000.0, 1e6))
      ->capture_default_str();
  verb->add_flag("--side", o.side, tr("the bur lies on its side instead of standing on its end"));
  verb->add_flag("--json", a->json, tr("one JSON object on standard output"));
  verb->callback([a, &exit_code] {
    run_grind(*a);
    exit_code = 0;
  });
}

void add_servo(CLI::App& rig, int& exit_code) {
  auto* verb = rig.add_subcommand(
      "servo",
      tr("Does this computer keep the servo's time? Drills in real time and records it. Exit 1 when a tick was late"));
  const auto a = std::make_shared<ServoArgs>();
  verb->add_option("--out", a->out, tr("session file to write (.cavum)"))->required();
  verb->add_option("--seconds", a->options.seconds, tr("how long"))
      ->check(between(1.0, 36000.0))
      ->capture_default_str();
  verb->add_option("--tick-ms", a->tick_ms, tr("length of a tick"))
      ->check(between(0.1, 10.0))
      ->capture_default_str();
  verb->add_option("--bur", a->bur, tr("bur: a name of data/burs, or a TOML file"))
      ->capture_default_str();
  verb->add_option("--model", a->model, tr("force model: paper, consistent, or a TOML file"))
      ->capture_default_str();
  verb->add_flag("--json", a->json, tr("one JSON object on standard output"));
  verb->callback([a, &exit_code] { exit_code = run_servo(*a) ? 0 : 1; });
}

void add_record(CLI::App& rig, int& exit_code) {
  auto* verb = rig.add_subcommand(
      "record",
      tr("A recording for `cavum explain`: the machine follows a motion into a cube, its load cell writes"));
  const auto a = std::make_shared<RecordArgs>();
  verb->add_option(
          "--motion", a->motion,
          tr("motion (.csv), z = height over the cube; `cavum explain --protocol` writes one"))
      ->required();
  verb->add_option("--csv", a->csv, tr("recording to write; rig.toml is written beside it"))
      ->required();
  verb->add_option("--model", a->model, tr("force model: paper, consistent, or a TOML file"))
      ->capture_default_str();
  verb->add_option("--bur", a->bur, tr("bur: a name of data/burs, or a TOML file"))
      ->capture_default_str();
  verb->add_option("--sessions", a->options.sessions, tr("each at a new place"))
      ->check(between(1, 100))
      ->capture_default_str();
  verb->add_option("--rate-hz", a->options.rate_hz, tr("rows in a second"))
      ->check(between(1.0, 1000.0))
      ->capture_default_str();
  verb->add_option("--noise-n", a->options.noise_n, tr("sd of a reading of the load cell"))
      ->check(between(0.0, 1.0))
      ->capture_default_str();
  verb->add_option("--seed", a->options.seed, tr("of noise and places"))
      ->check(seed_check())
      ->capture_default_str();
  verb->callback([a, &exit_code] {
    run_record(*a);
    exit_code = 0;
  });
}

}  // namespace

void add_rig_verbs(CLI::App& app, int& exit_code) {
  auto* rig = app.add_subcommand(
      "rig",
      tr("The paper's experiments on a virtual testing machine; the simulated Omni in closed loop"));
  rig->require_subcommand(1);
  add_cube(*rig, exit_code);
  add_tooth(*rig, exit_code);
  add_press(*rig, exit_code);
  add_grind(*rig, exit_code);
  add_servo(*rig, exit_code);
  add_record(*rig, exit_code);
}

}  // namespace cavum::ui
