// `cavum exam`: a timed exam from a motion file or a simulated candidate, recorded, graded and
// sealed.
#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "engine/base/file.h"
#include "engine/base/text.h"
#include "engine/device/hardware/stylus_kind.h"
#include "engine/physics/servo/real_time_json.h"
#include "grading/marking/close_exam.h"
#include "grading/records/candidate_id.h"
#include "grading/records/station_ticket.h"
#include "grading/result/result_json.h"
#include "scenarios/exam/live_exam.h"
#include "scenarios/exam/other_path.h"
#include "scenarios/operators/simulated_exam.h"
#include "ui/cli/full_disk.h"
#include "ui/cli/grant_options.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/interrupt.h"
#include "ui/parts/live_source.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"
#include "ui/parts/scenario_words.h"
#include "ui/report/report.h"

namespace cavum::ui {
namespace {

struct ExamArguments {
  std::string scenario, candidate, motion, operator_name, device, bur, out, out_if_full, ticket,
      tooth, model = "consistent", rubric, report;
  std::uint64_t seed = 1;
  int delay_ticks = 1;
  bool json = false, quiet = false, resume = false, end = false, model_given = false;
  scenarios::Grant grant;
};

/// One line on the terminal that shows time, step and removal; nothing when the output is no
/// terminal.
class ProgressBar {
 public:
  explicit ProgressBar(bool shown) : shown_(shown && ::isatty(STDERR_FILENO) == 1) {}
  ~ProgressBar() { clear(); }
  void show(const scenarios::Exam& exam, double progress) {
    show(exam.state().tick, progress, msg("{}", Authored{exam.instruction()}));
  }
  void show(std::int64_t tick, double progress, const Message& what) {
    if (!shown_) return;
    constexpr int k_width = 24, k_words = 70;
    const int filled = static_cast<int>(progress * k_width);
    std::string bar(static_cast<std::size_t>(filled), '=');
    bar.resize(k_width, ' ');
    std::string words = one_line(tr(what));
    words.resize(k_words, ' ');
    words.resize(whole_characters(words));
    std::cerr << fmt::format("\r[{}] {:3}:{:02}  {}", bar, tick / 60000, tick / 1000 % 60, words)
              << std::flush;
  }
  void clear() {
    if (shown_) std::cerr << "\r" << std::string(110, ' ') << "\r";
    shown_ = false;
  }

 private:
  bool shown_;
};

/// A motion file whose burs are all on the tray; else throws Error.
std::unique_ptr<scenarios::InputSource> read_motion(const std::string& path,
                                                    const std::vector<std::string>& tray) {
  const std::string text = read_text_file(path, k_largest_table);
  Motion motion = parse_motion(text, path);
  for (std::size_t i = 0; i < motion.samples.size(); ++i)
    if (const int bur = motion.samples[i].bur; bur >= static_cast<int>(tray.size()))
      throw Error(
          FileLocation{path, line_of_sample(text, i)},
          msgn("bur is {}, and the scenario has {} bur", "bur is {}, and the scenario has {} burs",
               static_cast<std::int64_t>(tray.size()), bur, tray.size()),
          tray.size() > 1 ? msg("write 0 for its first bur, at most {}", tray.size() - 1)
                          : msg("write 0 for its first bur"));
  return std::make_unique<scenarios::PlayedMotion>(std::move(motion), tray, path);
}

std::unique_ptr<scenarios::InputSource> make_source(const ExamArguments& o,
                                                    const scenarios::ExamSetup& setup) {
  if (!o.motion.empty()) return read_motion(o.motion, setup.bur_names);
  OmniModel omni;
  omni.delay_ticks = o.delay_ticks;
  return std::make_unique<scenarios::SimulatedCandidate>(
      scenarios::make_simulated_candidate(setup, o.operator_name, o.seed, omni));
}

MotionSource motion_source(const ExamArguments& o) {
  if (!o.motion.empty())
    return {SourceKind::motion_file, std::filesystem::path(o.motion).filename().string()};
  return {SourceKind::simulated_operator, o.operator_name};
}

Notes source_notes(const ExamArguments& o) {
  if (!o.motion.empty())
    return {{"motion_file", std::filesystem::path(o.motion).filename().string()}};
  return {{"operator", o.operator_name}, {"operator_seed", std::to_string(o.seed)}};
}

std::unique_ptr<scenarios::ExamSetup> make_setup(const ExamArguments& o,
                                                 const LiveSource* live = nullptr) {
  scenarios::ExamOptions options;
  options.candidate = o.candidate;
  options.tooth_file = o.tooth;
  options.force_model = o.model;
  options.rubric_file = o.rubric;
  options.source = motion_source(o);
  options.notes = source_notes(o);
  options.position_quantum_mm =
      o.motion.empty() ? OmniModel{}.quantum_mm
                       : motion_quantum_mm(read_text_file(o.motion, k_largest_table), o.motion);
  if (live != nullptr) {
    options.source = live->source();
    options.notes = live->notes();
    options.position_quantum_mm = live->position_quantum_mm();
    options.peak_n = live->peak_n();
    options.continuous_n = live->continuous_n();
  }
  options.grant = o.grant;
  std::optional<records::HeldTicket> held;
  if (!o.ticket.empty()) {
    held = records::read_ticket(o.ticket);
    records::require_unused(*held);
    records::use_ticket(*held, options);
  }
  auto setup = scenarios::prepare_exam(o.scenario, options);
  if (held) records::require_promised(*held, setup->session);
  show_texts_of(setup->scenario);
  return setup;
}

/// Begins to record, and uses the ticket up.
std::unique_ptr<scenarios::Exam> begin_exam(const ExamArguments& o,
                                            const scenarios::ExamSetup& setup, Vec3 first_tip_mm) {
  std::optional<records::HeldTicket> held;
  if (!o.ticket.empty()) held = records::read_ticket(o.ticket);
  return scenarios::start_on_first_writable_disk(
      o.out, o.out_if_full, [&](const std::string& path) {
        return records::begin_with_ticket(held ? &*held : nullptr, path, [&] {
          return scenarios::Exam::start(setup, path, first_tip_mm);
        });
      });
}

/// Grades what was recorded, seals the session with it, prints it. Returns the exit code: 1 where a
/// simulated candidate did not do what he is named for.
int finish(const ExamArguments& o, scenarios::Exam& exam, const nlohmann::json& servo = {}) {
  grading::ClosedExam closed;
  write_somewhere(exam, o.out_if_full, [&] { closed = grading::grade_and_close(exam); });
  const std::string& session = exam.recorder().path();
  records::remember_closed(closed.graded->session.notes, session);
  const grading::Result& result = closed.result;
  if (!o.json) {
    say(grading::to_text(result));
    say(msg("recorded: {}", session));
    std::cout << std::flush;
  }
  const bool failed_to = o.operator_name == "perforator" && !result.perforation.fault.perforated;
  if (failed_to)
    say_error(msg(
        "the perforator opened nothing that must not be opened: this recording is no example of a perforation"));
  try {  // the exam is sealed by now, whatever becomes of its report
    if (!o.report.empty())
      report::write_closing_report(o.report, session, result, *closed.graded,
                                   report::ReportReader::instructor);
  } catch (const Error& e) {
    throw Error(Name{o.report},
                msg("the exam is graded and sealed in {}, its report is not written ({})", session,
                    e.message()),
                msg("write it later: `cavum report {} --out FILE`", session));
  }
  if (o.json) {
    auto j = grading::with_words(grading::to_json(result));
    j["session"] = session;
    if (!servo.is_null()) j["servo"] = servo;
    print_json(j);
  } else if (!o.report.empty()) {
    say(msg("report: {}", std::filesystem::absolute(o.report).string()));
  }
  return failed_to ? 1 : 0;
}

/// What would spoil the end of an exam is said before it begins.
void require_paths(const ExamArguments& o) {
  const auto file = [](const std::string& model) {
    return model.ends_with(".toml") ? model : std::string();
  };
  require_distinct_paths({{"--out " + o.out, o.out},
                          {"--report " + o.report, o.report},
                          {"--out-if-full " + o.out_if_full, o.out_if_full}},
                         {{"", o.scenario},
                          {"", o.motion},
                          {"", o.tooth},
                          {"", o.rubric},
                          {"", file(o.model)},
                          {"", o.ticket}});
  if (!o.report.empty()) report::require_report_path(o.report);
}

/// How punctual the servo was: kept as an event of the session, and shown.
nlohmann::json servo_json(const scenarios::LiveReport& report) {
  nlohmann::json j = to_json(report.servo);
  j["first_disagreement"] = report.first_disagreement;
  return j;
}

/// An exam with a hand on it, until it is over, the operator is done, a signal comes or the device
/// fails. Returns 0 when it is over and sealed, 1 when it was only stopped: such a session can be
/// resumed.
int run_live(const ExamArguments& o, const scenarios::ExamSetup& setup, LiveSource& source,
             std::unique_ptr<scenarios::Exam> begun) {
  scenarios::LiveExam live(setup,
                           begun ? std::move(begun) : begin_exam(o, setup, source.first_tip_mm()),
                           source.device());
  live.exam().set_second_path(o.out_if_full);  // before its threads run
  RecordingWatch recording(o.out);
  recording.begun(live.exam().recorder().path());
  live.start();
  {
    ProgressBar bar(!o.json && !o.quiet);
    Message told;
    constexpr auto k_look = std::chrono::milliseconds(20);
    for (; live.running() && !Interrupt::asked(); std::this_thread::sleep_for(k_look)) {
      if (source.done()) live.ask_to_end();
      const scenarios::LiveView view = live.view();
      const double share = view.limit_ticks > 0
                               ? static_cast<double>(view.ticks - view.paused_ticks) /
                                     static_cast<double>(view.limit_ticks)
                               : 0.0;
      bar.show(view.ticks, std::min(1.0, share), msg("{}", Authored{view.instruction}));
      if (view.ticks > 0) recording.look(view.recording_error, view.session);
      const std::optional<Error> problem = source.problem();
      if (const Message now = problem ? problem->message() : Message(); now != told) {
        if (problem) {
          std::cerr << "\n";
          say_error(now);
        }
        told = now;
      }
    }
  }
  const scenarios::LiveReport& report = live.finish();
  const nlohmann::json servo = servo_json(report);
  scenarios::Exam& exam = live.exam();
  exam.recorder().add_event(std::max<std::int64_t>(0, exam.state().tick - 1),
                            ServoLateness{report.servo, report.first_disagreement});
  const Number worst = as_unit(report.servo.lateness.worst_us() * 1e-3, Unit::ms, 1);
  if (!o.json && !o.quiet)
    std::cerr << (report.servo.fifo.granted()
                      ? tr("servo: {} ticks, {} late, worst {}", report.servo.ticks,
                           report.servo.overruns, worst)
                      : tr("servo: {} ticks, {} late, worst {} (without SCHED_FIFO)",
                           report.servo.ticks, report.servo.overruns, worst))
              << "\n";
  if (exam.over()) return finish(o, exam, servo);
  write_somewhere(exam, o.out_if_full, [&exam] { exam.recorder().flush(); });
  const std::string& session = exam.recorder().path();
  const Message why = report.servo.failure.empty() ? msg("was stopped")
                                                   : msg("was stopped: {}", report.servo.failure);
  if (o.json)
    print_json(
        nlohmann::json{{"session", session}, {"stopped", english_text(why)}, {"servo", servo}});
  say_error(
      msg("{}: {}; go on with --resume --device, or close it as it stands with --resume --end",
          session, why));
  return 1;
}

std::unique_ptr<LiveSource> open_source(const ExamArguments& o) {
  return open_live_source(
      {.device = o.device, .operator_name = o.operator_name, .seed = o.seed, .bur = o.bur});
}

int run_new_live(const ExamArguments& o) {
  require_paths(o);
  const Interrupt interrupt;
  const auto source = open_source(o);
  const auto setup = make_setup(o, source.get());
  source->begin(*setup);
  return run_live(o, *setup, *source, nullptr);
}

int run_new(const ExamArguments& o) {
  records::require_candidate_id("--candidate", o.candidate);
  if (o.end)
    throw Error(Name{"--end"}, msg("closes an exam that was cut off"), msg("say --resume, too"));
  if (!o.device.empty()) return run_new_live(o);
  if (o.motion.empty() == o.operator_name.empty())
    throw Error(msg("exam"), msg("needs one source of motion"),
                msg("give --motion F.csv, --operator NAME, or --device NAME"));
  require_paths(o);
  const auto setup = make_setup(o);
  const auto source = make_source(o, *setup);
  const auto exam = begin_exam(o, *setup, source->start_mm());
  {
    RecordingWatch recording(o.out);
    recording.begun(exam->recorder().path());
    ProgressBar bar(!o.json && !o.quiet);
    scenarios::run_exam(*exam, *source, [&](const scenarios::Exam& e, double progress) {
      bar.show(e, progress);
      recording.look(e.recording_problem(), e.recorder().path());
    });
  }
  return finish(o, *exam);
}

/// What `cavum exam` runs when nothing at all is named: the simulated expert opens the shipped
/// molar, in a session with a report, here.
ExamArguments demonstration(ExamArguments o) {
  char name[64];
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  std::strftime(name, sizeof name, "cavum-demonstration-%Y%m%d-%H%M%S",
                ::localtime_r(&now, &local));
  o.scenario = scenarios::find_data_file("scenarios", "molar_access.toml", "");
  o.candidate = "demonstration";
  o.operator_name = "expert";
  o.out = fmt::format("{}.cavum", name);
  if (o.report.empty()) o.report = fmt::format("{}.html", name);
  return o;
}

bool names_nothing(const ExamArguments& o) {
  for (const auto& given : {o.scenario, o.candidate, o.ticket, o.motion, o.operator_name, o.device,
                            o.out, o.tooth, o.rubric})
    if (!given.empty()) return false;
  return true;
}

/// A session goes on with what it holds: whoever names something else has the wrong session or the
/// wrong file.
void require_same(const ExamArguments& o, const SessionSetup& held) {
  const auto differs = [](const std::string& option, const Message& what) {
    throw Error(Name{option}, what, msg("leave it out, or name another session with --out"));
  };
  if (!o.candidate.empty() && o.candidate != held.candidate)
    differs("--candidate " + o.candidate,
            msg("is not the candidate ('{}') that {} was begun with", held.candidate, o.out));
  if (!o.scenario.empty() && read_text_file(o.scenario) != held.scenario_toml)
    differs(o.scenario, msg("is not the scenario that {} was begun with", o.out));
  if (!o.tooth.empty() && read_file(o.tooth) != held.tooth)
    differs("--tooth " + o.tooth, msg("is not the tooth that {} was begun with", o.out));
  for (const auto& [key, value] : scenarios::notes_of(o.grant))
    if (std::find(held.notes.begin(), held.notes.end(), std::pair(key, value)) == held.notes.end())
      differs(fmt::format("{} {}", key, value),
              msg("is not the accommodation that {} was begun with", o.out));
  const std::string near_file = o.scenario.empty() ? "data/scenarios/any.toml" : o.scenario;
  if (o.model_given && scenarios::force_model_text(o.model, near_file) != held.force_model_toml)
    differs("--model " + o.model, msg("is not the force model that {} was begun with", o.out));
  if (!o.rubric.empty() && read_text_file(o.rubric) != held.rubric_toml)
    differs("--rubric " + o.rubric, msg("is not the rubric that {} was begun with", o.out));
}

/// Takes up a killed exam with new motion, or closes it as it stands.
int run_resumed(const ExamArguments& o) {
  if (o.motion.empty() && o.operator_name.empty() && o.device.empty() && !o.end)
    throw Error(
        msg("exam --resume"), msg("nothing to go on with"),
        msg("give --motion, --operator or --device to continue, or --end to close the exam as it stands"));
  require_paths(o);
  const SessionReader reader(o.out);
  reader.require_readable();
  if (!reader.closed())
    require_same(o, reader.setup());  // of a closed one, that it is closed says more
  const auto setup = scenarios::prepare_exam(reader.setup());
  show_texts_of(setup->scenario);
  ResumedBy by;
  if (!reader.closed())
    by.ticket_remembered = records::require_not_closed(setup->session.notes, o.out);
  if (!o.device.empty()) {
    const Interrupt interrupt;
    const auto live = open_source(o);
    if (live->position_quantum_mm() !=
        parse_servo_config(setup->session.servo_toml, o.out).position_quantum_mm)
      throw Error(Name{"--device " + o.device},
                  msg("has another encoder than the one that {} was begun with", o.out),
                  msg("go on with the same device, or close the exam with --end"));
    live->begin(*setup);
    return run_live(o, *setup, *live,
                    scenarios::Exam::resume(*setup, o.out,
                                            {live->source(), by.ticket_remembered, live->notes()}));
  }
  const bool moves = !o.motion.empty() || !o.operator_name.empty();
  // Before the session is opened for writing: a source that cannot be had leaves no gap behind.
  const auto source = moves ? make_source(o, *setup) : nullptr;
  if (moves) by = {motion_source(o), by.ticket_remembered, source_notes(o)};
  const auto exam = scenarios::Exam::resume(*setup, o.out, by);
  exam->set_second_path(o.out_if_full);
  if (source && exam->over()) {
    say_error(msg(
        "{}: this exam was over when it was interrupted: it is closed as it stands, and nothing more is run",
        o.out));
  } else if (source) {
    RecordingWatch recording(o.out);
    scenarios::run_exam(*exam, *source, [&](const scenarios::Exam& e, double) {
      recording.look(e.recording_problem(), e.recorder().path());
    });
  } else if (!exam->over()) {
    exam->end();
  }
  return finish(o, *exam);
}

}  // namespace

void add_exam_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<ExamArguments>();
  auto* exam = app.add_subcommand(
      "exam",
      tr("Run a timed exam, record it, grade it and seal the recording; without anything named, a demonstration"));
  exam->add_option("scenario", o->scenario, tr("scenario file (.toml)"));
  exam->add_option("--candidate", o->candidate, tr("candidate's pseudonym"));
  exam->add_option(
      "--ticket", o->ticket,
      tr("the school's promise of this exam (see `cavum ledger ticket`): says who sits it, and is kept in the session"));
  auto* motion = exam->add_option(
      "--motion", o->motion, tr("poses from a CSV file, from its first row on, with --resume too"));
  auto* name = exam->add_option(
      "--operator", o->operator_name,
      tr("simulated candidate: expert, novice, perforator, student-0 to student-100, or careless, who does what the scenario's [careless] says"));
  auto* device =
      exam->add_option("--device", o->device,
                       tr("in real time, without a window: {}, or {} with --operator as its hand",
                          list_of(stylus_kinds().ids({StylusHand::person})),
                          list_of(stylus_kinds().ids({StylusHand::candidate}))));
  motion->excludes(name);
  device->excludes(motion);
  exam->add_option("--bur", o->bur,
                   tr("with --device: bur mounted, of the scenario's tray; its first unless given"))
      ->needs(device);
  exam->add_option("--out", o->out, tr("session file to write (.cavum)"));
  exam->add_option(
      "--out-if-full", o->out_if_full,
      tr("session file, on another disk, to begin or go on with when --out cannot be written"));
  exam->add_option(
      "--tooth", o->tooth,
      tr("another tooth than the scenario's: zones that follow tissue follow this one"));
  const auto* model =
      exam->add_option("--model", o->model,
                       tr("force model: paper, consistent, clinical, or a TOML file"))
          ->capture_default_str();
  exam->add_option("--rubric", o->rubric,
                   tr("mark by this rubric (TOML) instead of the scenario's own"));
  add_grant_options(exam, o->grant);
  exam->add_option("--seed", o->seed, tr("of the simulated candidate's habits"))
      ->check(seed_check())
      ->capture_default_str();
  exam->add_option("--delay-ticks", o->delay_ticks, tr("of the simulated device, 0 to 3"))
      ->capture_default_str()
      ->check(between(0, 3));
  exam->add_flag("--end", o->end, tr("with --resume: close the exam as it stands"));
  exam->add_option("--report", o->report, tr("also write the instructor's report: .html or .pdf"));
  exam->add_flag(
      "--resume", o->resume,
      tr("take up the exam in --out, which was killed or stopped: with --motion, --operator, --device or --end"));
  exam->add_flag("--json", o->json, tr("one JSON object on standard output: the result"));
  exam->add_flag("--quiet", o->quiet, tr("no progress bar"));
  exam->callback([o, model, &exit_code] {
    o->model_given = model->count() > 0;
    if (!o->resume && names_nothing(*o)) *o = demonstration(*o);
    if (o->out.empty())
      throw Error(msg("exam"), msg("no session file to write is named"),
                  msg("add --out with a name such as exam.cavum"));
    if (!o->resume && o->scenario.empty())
      throw Error(msg("exam"), msg("no scenario given"),
                  msg("name a file such as data/scenarios/molar_access.toml"));
    if (!o->resume && o->candidate.empty() && o->ticket.empty())
      throw Error(msg("exam"), msg("no candidate given"),
                  msg("add --candidate with a pseudonym, or --ticket"));
    exit_code = o->resume ? run_resumed(*o) : run_new(*o);
  });
}

}  // namespace cavum::ui
