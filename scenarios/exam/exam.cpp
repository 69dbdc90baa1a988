#include "scenarios/exam/exam.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/shipped.h"
#include "scenarios/file/rubric_check.h"
#include "scenarios/file/surface_files.h"
#include "scenarios/zones/placed.h"

namespace cavum::scenarios {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> data_folders(const std::string& folder, const std::string& near_file) {
  std::vector<fs::path> places;
  for (const auto& data : shipped_folders(near_file)) places.push_back(data / folder);
  return places;
}

}  // namespace

std::vector<std::string> data_names(const std::string& folder, const std::string& near_file) {
  for (const auto& place : data_folders(folder, near_file)) {
    std::error_code none;
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(place, none))
      if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    if (!names.empty()) return names;
  }
  return {};
}

std::string find_data_file(const std::string& folder, const std::string& name,
                           const std::string& near_file) {
  std::string looked;
  for (const auto& place : data_folders(folder, near_file)) {
    const fs::path p = place / name;
    if (fs::exists(p)) return p.lexically_normal().string();
    looked += (looked.empty() ? "" : ", ") + p.lexically_normal().string();
  }
  throw Error(fmt::format("{}/{}", folder, name),
              msg("is nowhere to be found (looked at {})", looked),
              msg("correct the name or set CAVUM_DATA to the data folder"));
}

std::string force_model_path(const std::string& wanted, const std::string& near_file) {
  if (wanted.ends_with(".toml")) return wanted;
  if (wanted.empty() || wanted.find('/') != std::string::npos) {
    std::string known;
    for (const auto& name : data_names("materials", near_file))
      known += (known.empty() ? "" : ", ") + name;
    throw Error("--model", msg("'{}' is no force model", wanted),
                msg("name one of {}, or a file ending in .toml", known));
  }
  return find_data_file("materials", wanted + ".toml", near_file);
}

std::string force_model_text(const std::string& wanted, const std::string& near_file) {
  return read_text_file(force_model_path(wanted, near_file));
}

std::vector<Message> check_servo(const std::string& servo_toml, const Scenario& scenario) {
  const ServoConfig is = parse_servo_config(servo_toml, "servo.toml"), usual;
  std::vector<Message> findings;
  const auto same = [&](const char* name, double value, double wanted) {
    if (value != wanted)
      findings.push_back(msg("servo.toml: {} is {}, and exams of this scenario run with {}", name,
                             as_number(value), as_number(wanted)));
  };
  const auto at_most = [&](const char* name, double value, double most) {
    if (!(value > 0 && value <= most)) same(name, value, most);
  };
  constexpr double k_coarsest_mm = 0.1;  // no stylus for exams resolves less
  same("tick_s", is.tick_s, usual.tick_s);
  same("max_rpm", is.max_rpm, scenario.max_rpm);
  same("spin_up_s", is.spin_up_s, usual.spin_up_s);
  same("slew_n_per_s", is.limits.slew_n_per_s, usual.limits.slew_n_per_s);
  same("sustained_budget_n_s", is.limits.sustained_budget_n_s, usual.limits.sustained_budget_n_s);
  same("watchdog_s", is.limits.watchdog_s, usual.limits.watchdog_s);
  at_most("peak_n", is.limits.peak_n, usual.limits.peak_n);
  at_most("continuous_n", is.limits.continuous_n, usual.limits.continuous_n);
  if (is.position_quantum_mm > k_coarsest_mm)
    same("position_quantum_mm", is.position_quantum_mm, k_coarsest_mm);
  return findings;
}

ExamTask exam_task(SessionSetup session, const std::string& scenario_name,
                   const std::vector<std::string>& bur_names) {
  ExamTask task{parse_scenario(session.scenario_toml, scenario_name), {}, {}, std::move(session)};
  use_surfaces(task.scenario, task.session.attachments);
  task.scenario.accommodations =
      granted(task.scenario.accommodations, task.session.notes, scenario_name);
  for (std::size_t i = 0; i < task.session.burs_toml.size(); ++i) {
    task.burs.push_back(
        parse_bur(task.session.burs_toml[i],
                  i < bur_names.size() ? bur_names[i] : fmt::format("bur_{:03}.toml", i)));
    task.bur_names.push_back(task.burs.back().name);
  }
  return task;
}

std::unique_ptr<ExamSetup> prepare_exam(const std::string& scenario_path,
                                        const ExamOptions& options) {
  SessionSetup s;
  s.scenario_toml = read_text_file(scenario_path);
  Scenario scenario = parse_scenario(s.scenario_toml, scenario_path);
  if (const auto wrong = read_surfaces(scenario, s.attachments); !wrong.empty())
    throw Error(wrong[0].where, wrong[0].what, wrong[0].what_to_do);
  s.candidate = options.candidate;
  s.source = options.source;
  require_sound(options.grant, msg("the accommodations"));
  s.notes = options.notes;
  for (auto& note : notes_of(options.grant)) s.notes.push_back(std::move(note));
  const std::string tooth_path =
      options.tooth_file.empty() ? find_tooth_file(scenario) : options.tooth_file;
  s.tooth = read_file(tooth_path);
  const std::string model_path = force_model_path(options.force_model, scenario_path);
  s.force_model_toml = read_text_file(model_path);
  static_cast<void>(parse_force_model(s.force_model_toml,
                                      model_path));  // its mistakes are named with its own file
  std::vector<std::string> bur_paths;
  for (const auto& name : scenario.burs) {
    bur_paths.push_back(find_data_file("burs", name + ".toml", scenario_path));
    s.burs_toml.push_back(read_text_file(bur_paths.back()));
  }
  if (!options.rubric_file.empty()) {
    s.rubric_toml = read_text_file(options.rubric_file);
  }
  ServoConfig config;
  config.max_rpm = scenario.max_rpm;
  config.position_quantum_mm = options.position_quantum_mm;
  // A device that bears more than usual gives no more: every candidate feels the same tooth.
  if (options.peak_n > 0) config.limits.peak_n = std::min(config.limits.peak_n, options.peak_n);
  if (options.continuous_n > 0)
    config.limits.continuous_n = std::min(config.limits.continuous_n, options.continuous_n);
  s.servo_toml = to_toml(config);
  auto setup = std::make_unique<ExamSetup>(
      ExamSetup{exam_task(std::move(s), scenario_path, bur_paths), {}, {}});
  setup->tooth = load_tooth(setup->session.tooth, tooth_path);
  setup->session.landmarks_json = landmarks_to_keep(setup->scenario, setup->tooth);
  setup->zones = build_zones_of_exam(setup->scenario, setup->tooth, setup->session.landmarks_json,
                                     scenario_path);
  require_tissues(setup->scenario, setup->tooth);
  if (!options.rubric_file.empty())
    require_none(not_in_this_exam(parse_rubric(setup->session.rubric_toml, options.rubric_file),
                                  setup->scenario, setup->tooth));
  return setup;
}

std::unique_ptr<ExamSetup> prepare_exam(const SessionSetup& session) {
  auto setup = std::make_unique<ExamSetup>(ExamSetup{exam_task(session, "scenario.toml"), {}, {}});
  setup->tooth = load_tooth(session.tooth, "start_tooth.cvt");
  setup->zones =
      build_zones_of_exam(setup->scenario, setup->tooth, session.landmarks_json, "scenario.toml");
  return setup;
}

Exam::Exam(const ExamSetup& setup, Simulation simulation)
    : setup_(setup),
      runner_(setup.scenario, setup.zones, setup.tooth, setup.bur_names),
      simulation_(std::move(simulation)) {}

std::unique_ptr<Exam> Exam::start(const ExamSetup& setup, const std::string& path,
                                  Vec3 first_tip_mm, const ReadClocks& clocks) {
  SessionSetup session = setup.session;
  const TickInput first = make_tick_input({first_tip_mm, {}}, 0, k_stylus_fresh, 0, {});
  session.first_tip_nm = first.tip_nm;
  std::unique_ptr<Exam> exam(new Exam(setup, make_simulation(session, path, &setup.tooth)));
  exam->last_input_ = first;
  exam->last_.proxy_mm = first_tip_mm;
  exam->recorder_.emplace(Recorder::create(path, session, clocks));
  return exam;
}

std::unique_ptr<Exam> Exam::resume(const ExamSetup& setup, const std::string& path,
                                   const ResumedBy& by, const ReadClocks& clocks) {
  std::unique_ptr<Exam> exam(new Exam(setup, {}));
  ResumedSession resumed = resume_session(
      path,
      [&](std::int64_t, const TickInput& input, const TickOutput& output, const ServoState& state) {
        exam->runner_.advance(*exam->runner_state_, input, output, state.removed);
        exam->last_input_ = input;
        exam->last_ = output;
      },
      by, clocks);
  if (resumed.ticks == 0) {
    exam->last_input_.tip_nm = resumed.setup.first_tip_nm;
    exam->last_.proxy_mm = resumed.setup.first_tip_mm();
  }
  exam->events_recorded_ = exam->runner_state_->event_count;
  exam->simulation_ = std::move(resumed.simulation);
  exam->recorder_.emplace(std::move(resumed.recorder));
  return exam;
}

void Exam::record_events() {
  for (auto& e : runner_state_->events_from(events_recorded_))
    recorder_->add_event(e.tick, std::move(e.event));
  events_recorded_ = runner_state_->event_count;
}

const TickOutput& Exam::tick(const TickInput& wanted) {
  TickInput input = wanted;
  if (Runner::paused(*runner_state_))
    input.pedal_q16 = 0;  // what is recorded is what the step consumed
  return follow(input);
}

const TickOutput& Exam::follow(const TickInput& input) {
  last_input_ = input;
  last_ = step(simulation_.model, simulation_.state, input);
  runner_.advance(*runner_state_, input, last_, simulation_.state.removed);
  record_events();  // before the tick, so that both are written in one transaction
  try {
    recorder_->append(input, make_tick_record(last_), simulation_.state.removed,
                      state_hash(simulation_.state));
  } catch (const DatabaseError& refusal) {
    keep(refusal);
  }
  if (!problem_.empty() && recorder_->ticks() - recorder_->ticks_on_disk() < k_chunk_ticks)
    problem_ = {};  // all but the running second is on disk
  return last_;
}

/// The tick is in the recorder's memory. Without a second place it is tried again with the next
/// second.
void Exam::keep(const DatabaseError& refusal) {
  problem_ = refusal.message();
  if (second_path_.empty() || recorder_->path() == second_path_) return;
  try {
    recorder_->move_to(second_path_, refusal.refusal());
  } catch (const Error& also) {
    problem_ = msg("{}; and elsewhere: {}", problem_, also.message());
  }
}

void Exam::end() {
  runner_.end(*runner_state_);
  record_events();
}

void Exam::note_late(std::int64_t ticks, std::int64_t pedal_ticks) {
  recorder_->add_event(runner_state_->ticks - 1, WorkAfterEnd{ticks, pedal_ticks});
}

void Exam::close(const std::string& result_json) {
  recorder_->close(save_tooth(tooth_now()), result_json);
}

}  // namespace cavum::scenarios
