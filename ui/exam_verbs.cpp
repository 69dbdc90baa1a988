// `cavum exam`: a timed exam from a motion file or a simulated candidate, recorded, graded and sealed.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "engine/base/text.h"
#include "grading/close_exam.h"
#include "grading/report.h"
#include "grading/result_json.h"
#include "scenarios/simulated_exam.h"
#include "ui/own_places.h"
#include "ui/print_json.h"
#include "ui/seed_check.h"
#include "ui/verbs.h"

namespace cavum {
namespace {

struct Options {
  std::string scenario, candidate, motion, operator_name, device, out, tooth, model = "consistent", rubric, report;
  std::uint64_t seed = 1;
  int delay_ticks = 1;
  bool json = false, quiet = false, resume = false, end = false, model_given = false;
  Grant grant;
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

/// Line of the file that holds sample `sample` of a motion that parse_motion has accepted: header, comments and empty
/// lines give no sample.
std::size_t line_of_sample(std::string_view text, std::size_t sample) {
  constexpr std::string_view k_byte_order_mark = "\xef\xbb\xbf";
  if (text.starts_with(k_byte_order_mark)) text.remove_prefix(k_byte_order_mark.size());
  std::size_t number = 0, rows = 0;
  while (!text.empty()) {
    ++number;
    const auto end = std::min(text.find_first_of("\r\n"), text.size());
    const auto first = text.substr(0, end).find_first_not_of(" \t");
    if (first != std::string_view::npos && text[first] != '#' && ++rows == sample + 2) break;  // the header is row 1
    text.remove_prefix(std::min(text.size(), end + (text.substr(end).starts_with("\r\n") ? 2 : 1)));
  }
  return number;
}

/// A motion file whose diamond points are all on the tray; else throws Error.
std::unique_ptr<InputSource> read_motion(const std::string& path, const std::vector<std::string>& tray) {
  const std::string text = read_text_file(path);
  Motion motion = parse_motion(text, path);
  for (std::size_t i = 0; i < motion.samples.size(); ++i)
    if (const int point = motion.samples[i].point; point >= static_cast<int>(tray.size()))
      throw Error(
          path + ":" + std::to_string(line_of_sample(text, i)),
          "point is " + std::to_string(point) + ", and the scenario has " + std::to_string(tray.size()) + (tray.size() == 1 ? " point" : " points"),
          "write 0 for its first point" + (tray.size() > 1 ? ", at most " + std::to_string(tray.size() - 1) : std::string()));
  return std::make_unique<PlayedMotion>(std::move(motion), tray, path);
}

std::unique_ptr<InputSource> make_source(const Options& o, const ExamSetup& setup) {
  if (!o.motion.empty()) return read_motion(o.motion, setup.point_names);
  OmniModel omni;
  omni.delay_ticks = o.delay_ticks;
  return std::make_unique<SimulatedCandidate>(make_simulated_candidate(setup, o.operator_name, o.seed, omni));
}

std::string source_name(const Options& o) { return o.motion.empty() ? "simulated Omni, operator " + o.operator_name : "motion file"; }

SourceNotes source_notes(const Options& o) {
  if (!o.motion.empty()) return {{"motion_file", std::filesystem::path(o.motion).filename().string()}};
  return {{"operator", o.operator_name}, {"operator_seed", std::to_string(o.seed)}};
}

std::unique_ptr<ExamSetup> make_setup(const Options& o) {
  ExamOptions options;
  options.candidate = o.candidate;
  options.tooth_file = o.tooth;
  options.force_model = o.model;
  options.rubric_file = o.rubric;
  options.device = source_name(o);
  options.notes = source_notes(o);
  if (o.motion.empty()) options.position_quantum_mm = OmniModel{}.quantum_mm;
  options.grant = o.grant;
  return prepare_exam(o.scenario, options);
}

/// Grades what was recorded, seals the session with it, prints it.
void finish(const Options& o, Exam& exam) {
  const ClosedExam closed = grade_and_close(exam, o.out);
  const Result& result = closed.result;
  if (!o.report.empty()) write_text_file(o.report, report_html(result, closed.graded->input(), closed.graded->facts));
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
  const auto file = [](const std::string& model) { return model.ends_with(".toml") ? model : std::string(); };
  require_own_places({{"--out " + o.out, o.out}, {"--report " + o.report, o.report}},
                     {{"", o.scenario}, {"", o.motion}, {"", o.tooth}, {"", o.rubric}, {"", file(o.model)}});
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

/// A session goes on with what it holds: whoever names something else has the wrong session or the wrong file.
void require_same(const Options& o, const SessionSetup& held) {
  const auto differs = [&o](const std::string& option, const std::string& what) {
    throw Error(option, "is not the " + what + " that " + o.out + " was begun with", "leave it out, or name another session with --out");
  };
  if (!o.candidate.empty() && o.candidate != held.candidate) differs("--candidate " + o.candidate, "candidate ('" + held.candidate + "')");
  if (!o.scenario.empty() && read_text_file(o.scenario) != held.scenario_toml) differs(o.scenario, "scenario");
  if (!o.tooth.empty() && read_file(o.tooth) != held.tooth) differs("--tooth " + o.tooth, "tooth");
  for (const auto& [key, value] : notes_of(o.grant))
    if (std::find(held.notes.begin(), held.notes.end(), std::pair(key, value)) == held.notes.end()) differs(key + " " + value, "accommodation");
  const std::string near_file = o.scenario.empty() ? "data/scenarios/any.toml" : o.scenario;
  if (o.model_given && force_model_text(o.model, near_file) != held.force_model_toml) differs("--model " + o.model, "force model");
  if (!o.rubric.empty() && read_text_file(o.rubric) != held.rubric_toml) differs("--rubric " + o.rubric, "rubric");
}

/// Takes up a killed exam with new motion, or closes it as it stands.
void run_resumed(const Options& o) {
  if (o.motion.empty() && o.operator_name.empty() && !o.end)
    throw Error("cavum exam --resume", "nothing to go on with", "give --motion or --operator to continue, or --end to close the exam as it stands");
  require_places(o);
  const SessionReader reader(o.out);
  reader.require_readable();
  if (!reader.closed()) require_same(o, reader.setup());  // of a closed one, that it is closed says more
  const auto setup = prepare_exam(reader.setup());
  const bool moves = !o.motion.empty() || !o.operator_name.empty();
  // Before the session is opened for writing: a source that cannot be had leaves no gap behind.
  const auto source = moves ? make_source(o, *setup) : nullptr;
  SourceNotes notes;
  if (moves) {
    notes = source_notes(o);
    notes.emplace_back("device", source_name(o));
  }
  const auto exam = Exam::resume(*setup, o.out, notes);
  if (source) {
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
  auto* name = exam->add_option("--operator", o->operator_name,
                                "simulated candidate: expert, novice, perforator, or careless, who does what the scenario's [careless] says");
  auto* device = exam->add_option("--device", o->device, "haptic device by name; this version drives none");
  motion->excludes(name);
  device->excludes(name)->excludes(motion);
  exam->add_option("--out", o->out, "session file to write (.cavum)")->required();
  exam->add_option("--tooth", o->tooth, "another tooth than the scenario's: zones that follow tissue follow this one");
  const auto* model = exam->add_option("--model", o->model, "force model: paper, consistent, or a TOML file")->capture_default_str();
  exam->add_option("--rubric", o->rubric, "mark by this rubric (TOML) instead of the scenario's own");
  exam->add_option("--extra-time-percent", o->grant.extra_time_percent, "extra time for this candidate, instead of the scenario's");
  exam->add_option("--extra-time-s", o->grant.extra_time_s, "the same in seconds; both add up");
  exam->add_flag("--left-handed,!--right-handed", o->grant.left_handed, "for this candidate; recorded and shown with the result");
  exam->add_flag("--high-contrast,!--normal-contrast", o->grant.high_contrast, "for this candidate; recorded and shown with the result");
  exam->add_option("--seed", o->seed, "of the simulated candidate's habits")->check(seed_check())->capture_default_str();
  exam->add_option("--delay-ticks", o->delay_ticks, "of the simulated device, 0 to 3")->capture_default_str()->check(CLI::Range(0, 3));
  exam->add_flag("--end", o->end, "with --resume: close the exam as it stands");
  exam->add_option("--report", o->report, "also write the report (HTML)");
  exam->add_flag("--resume", o->resume, "take up the exam in --out, which was killed: with --motion, --operator or --end");
  exam->add_flag("--json", o->json, "one JSON object on standard output: the result");
  exam->add_flag("--quiet", o->quiet, "no progress bar");
  exam->callback([o, model, &exit_code] {
    o->model_given = model->count() > 0;
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
