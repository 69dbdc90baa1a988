// `cavum exam`: a timed exam from a motion file or a simulated candidate, recorded, graded and sealed.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "engine/base/text.h"
#include "grading/report.h"
#include "grading/result_json.h"
#include "grading/session_input.h"
#include "scenarios/simulated_exam.h"
#include "ui/print_json.h"
#include "ui/verbs.h"

namespace cavum {
namespace {

struct Options {
  std::string scenario, candidate, motion, operator_name, device, out, tooth, model = "consistent", rubric, report;
  std::uint64_t seed = 1;
  int delay_ticks = 1;
  bool json = false, quiet = false, resume = false, end = false;
};

/// One line on the terminal that shows time, step and removal; nothing when the output is no terminal.
class ProgressBar {
 public:
  explicit ProgressBar(bool shown) : shown_(shown && ::isatty(STDERR_FILENO) == 1) {}
  ~ProgressBar() { clear(); }
  void show(const Exam& exam, double progress) {
    if (!shown_) return;
    constexpr int k_width = 24;
    const int filled = static_cast<int>(progress * k_width);
    std::string bar(static_cast<std::size_t>(filled), '=');
    bar.resize(k_width, ' ');
    const auto tick = exam.state().tick;
    std::fprintf(stderr, "\r[%s] %3lld:%02lld  %-70.70s", bar.c_str(), static_cast<long long>(tick / 60000), static_cast<long long>(tick / 1000 % 60),
                 exam.instruction().c_str());
  }
  void clear() {
    if (shown_) std::fprintf(stderr, "\r%110s\r", "");
    shown_ = false;
  }

 private:
  bool shown_;
};

std::unique_ptr<InputSource> make_source(const Options& o, const ExamSetup& setup) {
  if (!o.motion.empty()) return std::make_unique<PlayedMotion>(parse_motion(read_text_file(o.motion), o.motion), setup.point_names, o.motion);
  std::vector<ContactTool> tray;
  for (const auto& p : setup.points) tray.push_back(make_contact_tool(p));
  OmniModel omni;
  omni.delay_ticks = o.delay_ticks;
  return std::make_unique<SimulatedCandidate>(make_candidate(o.operator_name, setup.scenario, setup.zones, setup.tooth, tray, o.seed), omni);
}

std::unique_ptr<ExamSetup> make_setup(const Options& o) {
  ExamOptions options;
  options.candidate = o.candidate;
  options.tooth_file = o.tooth;
  options.force_model = o.model;
  options.rubric_file = o.rubric;
  if (!o.motion.empty()) {
    options.device = "motion file";
    options.notes.emplace_back("motion_file", std::filesystem::path(o.motion).filename().string());
  } else {
    options.device = "simulated Omni, operator " + o.operator_name;
    options.notes.emplace_back("operator", o.operator_name);
    options.notes.emplace_back("operator_seed", std::to_string(o.seed));
  }
  return prepare_exam(o.scenario, options);
}

/// Grades what was recorded, seals the session with it, prints it.
void finish(const Options& o, Exam& exam) {
  exam.recorder().flush();
  const auto graded = load_for_grading(SessionReader(o.out), exam.tooth_now());
  const Result result = grade(graded->input(), graded->rubric);
  exam.close(to_json(result).dump());
  if (!o.report.empty()) write_text_file(o.report, report_html(result, graded->input(), graded->facts));
  if (o.json) {
    auto j = to_json(result);
    j["session"] = o.out;
    print_json(j);
  } else {
    std::cout << to_text(result) << "recorded: " << o.out << "\n";
    if (!o.report.empty()) std::cout << "report:   " << std::filesystem::absolute(o.report).string() << "\n";
  }
}

/// What would spoil the end of an exam is said before it begins.
void require_places(const Options& o) {
  require_writable(o.out);
  if (o.report.empty()) return;
  require_writable(o.report);
  if (std::filesystem::weakly_canonical(o.report) == std::filesystem::weakly_canonical(o.out))
    throw Error("--report " + o.report, "is also the name of the session", "give the report a name of its own");
}

void run_new(const Options& o) {
  if (o.motion.empty() == o.operator_name.empty())
    throw Error("cavum exam", "needs one source of motion", "give either --motion F.csv or --operator NAME");
  if (!is_plain_text(o.candidate)) throw Error("--candidate", "holds a control character or bytes that are no UTF-8", "use letters and digits");
  require_places(o);
  const auto setup = make_setup(o);
  const auto source = make_source(o, *setup);
  const auto exam = Exam::start(*setup, o.out, source->start_mm());
  {
    ProgressBar bar(!o.json && !o.quiet);
    run_exam(*exam, *source, [&bar](const Exam& e, double progress) { bar.show(e, progress); });
  }
  finish(o, *exam);
}

/// Takes up a killed exam with new motion, or closes it as it stands.
void run_resumed(const Options& o) {
  if (o.motion.empty() && o.operator_name.empty() && !o.end)
    throw Error("cavum exam --resume", "nothing to go on with", "give --motion or --operator to continue, or --end to close the exam as it stands");
  require_places(o);
  const SessionReader reader(o.out);
  reader.require_readable();
  const auto setup = prepare_exam(reader.setup());
  const auto exam = Exam::resume(*setup, o.out);
  if (!o.motion.empty()) {
    PlayedMotion source(parse_motion(read_text_file(o.motion), o.motion), setup->point_names, o.motion);
    run_exam(*exam, source);
  } else if (!o.operator_name.empty()) {
    const auto source = make_source(o, *setup);
    run_exam(*exam, *source);
  } else if (!exam->over()) {
    exam->end();
  }
  finish(o, *exam);
}

}  // namespace

void add_exam_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<Options>();
  auto* exam = app.add_subcommand("exam", "Run a timed exam, record it, grade it and seal the recording");
  exam->add_option("scenario", o->scenario, "scenario file (.toml)");
  exam->add_option("--candidate", o->candidate, "candidate's pseudonym");
  auto* motion = exam->add_option("--motion", o->motion, "poses from a CSV file");
  auto* name = exam->add_option("--operator", o->operator_name, "simulated candidate: expert, novice or perforator");
  auto* device = exam->add_option("--device", o->device, "haptic device by name, as `cavum devices` lists it");
  motion->excludes(name);
  device->excludes(name)->excludes(motion);
  exam->add_option("--out", o->out, "session file to write (.cavum)")->required();
  exam->add_option("--tooth", o->tooth, "another tooth than the scenario's: zones that follow tissue follow this one");
  exam->add_option("--model", o->model, "force model: paper, consistent, or a TOML file")->capture_default_str();
  exam->add_option("--rubric", o->rubric, "mark by this rubric (TOML) instead of the scenario's own");
  exam->add_option("--seed", o->seed, "of the simulated candidate's habits")->capture_default_str();
  exam->add_option("--delay-ticks", o->delay_ticks, "of the simulated device, 0 to 3")->capture_default_str()->check(CLI::Range(0, 3));
  exam->add_flag("--end", o->end, "with --resume: close the exam as it stands");
  exam->add_option("--report", o->report, "also write the report (HTML)");
  exam->add_flag("--resume", o->resume, "take up the exam in --out, which was killed: with --motion, --operator or --end");
  exam->add_flag("--json", o->json, "one JSON object on standard output: the result");
  exam->add_flag("--quiet", o->quiet, "no progress bar");
  exam->callback([o, &exit_code] {
    if (!o->device.empty()) throw Error("--device " + o->device, "no haptic device is driven by this version", "use --operator or --motion");
    if (o->resume) {
      run_resumed(*o);
    } else {
      if (o->scenario.empty()) throw Error("cavum exam", "no scenario given", "name a file such as data/scenarios/molar_access.toml");
      if (o->candidate.empty()) throw Error("cavum exam", "no candidate given", "add --candidate with a pseudonym");
      run_new(*o);
    }
    exit_code = 0;
  });
}

}  // namespace cavum
