#include "ui/station/sitting.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/file_name.h"
#include "engine/base/text.h"
#include "engine/base/write_file.h"
#include "engine/session/session_reader.h"
#include "grading/records/begin.h"
#include "grading/records/candidate_id.h"
#include "grading/records/station_ticket.h"
#include "scenarios/exam/other_path.h"
#include "ui/station/replay_player.h"

namespace cavum::station {
namespace {

template <class T>
bool is_ready(const std::future<T>& f) {
  return f.valid() && f.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// The ticket of a candidate who typed this code, in capitals or not, a pseudonym also without its
/// dashes.
records::HeldTicket ticket_of(const std::string& folder, const std::string& code) {
  std::string name = code;
  for (char& c : name) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  const auto path_of = [&folder](const std::string& candidate) {
    return fmt::format("{}/{}.ticket", folder, file_name_of(candidate));
  };
  std::string path = path_of(name);
  if (const std::string pseudonym = records::pseudonym_typed(code);
      !pseudonym.empty() && !std::filesystem::exists(path))
    path = path_of(pseudonym);
  if (!std::filesystem::exists(path))
    throw Error(msg("candidate '{}'", one_line(code)), msg("has no ticket here"),
                msg("check the code, or ask the school"));
  return records::read_ticket(path);
}

/// The exam bears the office's word. Without one it begins when its ticket lets it
/// (require_promised). Nothing is asked for what the ticket does not promise: the office would take
/// the exam for begun.
void ask_for_word(records::HeldTicket& held,
                  const std::function<std::string(const std::string&)>& word,
                  SessionSetup& session) {
  records::HeldTicket promised = held;
  promised.ticket.begun_at_ledger = false;
  records::require_promised(promised, session);
  const std::string said = word(held.ticket.nonce);
  if (said.empty()) return;
  static_cast<void>(records::parse_begin(said, held.ticket.public_key, msg("the office's word")));
  write_private_text_file(records::begin_path(held.path), said + "\n");
  held.begin = said;
  std::erase_if(session.notes, [](const auto& note) {
    return note.first == records::k_begin_note;
  });  // an earlier one
  session.notes.emplace_back(records::k_begin_note, said);
}

/// Enough on its disk for the end of any exam.
bool has_room(const std::string& path) {
  constexpr std::uintmax_t k_room_bytes = 8'000'000;
  std::error_code none;
  const auto space = std::filesystem::space(std::filesystem::absolute(path).parent_path(), none);
  return !none && space.available > k_room_bytes;
}

std::string require_resumable(const std::string& path, const std::string& candidate,
                              const StationDevice& device) {
  const SessionReader session(path);
  session.require_readable();
  if (session.closed())
    throw Error(Name{path}, msg("is closed: there is nothing to go on with"),
                msg("look at it with `cavum station --replay {}`", path));
  const SessionSetup setup = session.setup();
  if (setup.candidate != candidate && setup.candidate != records::pseudonym_typed(candidate))
    throw Error(msg("candidate '{}'", one_line(candidate)), msg("did not begin this exam"),
                msg("type the code that it was begun with"));
  if (parse_servo_config(setup.servo_toml, path).position_quantum_mm !=
      device.position_quantum_mm())
    throw Error(in_words(device.source()),
                msg("has another encoder than the stylus that this exam was begun with"),
                msg("go on with that one"));
  return setup.candidate;
}

/// What was recorded so far, taken again from its inputs.
Begun begun_so_far(const std::string& path) {
  constexpr double k_at_once_s = 3600.0;
  ReplayPlayer player(path);
  player.seek(player.ticks());
  while (!player.work(k_at_once_s)) {
  }
  player.show();
  const scenarios::RunnerState& at = player.shown().runner;
  const auto limit = static_cast<double>(scenarios::exam_limit_ticks(player.setup().scenario));
  return {player.tooth(),
          std::max(0.0, (limit - static_cast<double>(at.ticks - at.paused_ticks)) * k_tick_s),
          player.shown().input.bur};
}

}  // namespace

std::vector<Bur> read_shelf(const std::string& scenario_path) {
  std::vector<Bur> shelf;
  for (const auto& name : scenarios::data_names("burs", scenario_path)) {
    const std::string path = scenarios::find_data_file("burs", name + ".toml", scenario_path);
    shelf.push_back(parse_bur(read_text_file(path), path));
  }
  return shelf;
}

scenarios::Scenario scenario_of(const SittingOptions& o) {
  return o.resume.empty() ? scenarios::parse_scenario(read_text_file(o.scenario), o.scenario)
                          : scenarios::prepare_exam(SessionReader(o.resume).setup())->scenario;
}

Sitting::Sitting(SittingOptions options, std::string candidate)
    : options_(std::move(options)),
      candidate_(std::move(candidate)),
      device_(make_station_device(options_.device)) {
  scenarios::ExamOptions exam;
  exam.candidate = candidate_;
  exam.tooth_file = options_.tooth;
  exam.force_model = options_.model;
  exam.rubric_file = options_.rubric;
  exam.position_quantum_mm = device_->position_quantum_mm();
  exam.peak_n = device_->peak_n();
  exam.continuous_n = device_->continuous_n();
  exam.grant = options_.grant;
  exam.notes = device_->notes();
  if (options_.practice) exam.notes.emplace_back("practice", "true");
  if (options_.locked) exam.notes.emplace_back("locked", "yes");
  exam.source = source();
  std::optional<records::HeldTicket> held;
  if (!options_.tickets.empty()) {
    held = ticket_of(options_.tickets, candidate_);
    candidate_ = exam.candidate = held->ticket.candidate;
    if (options_.resume.empty() && !options_.practice) {
      records::require_unused(*held);
      ticket_ = held;
    }
  }
  if (!options_.resume.empty()) {
    candidate_ = require_resumable(options_.resume, candidate_, *device_);
    options_.practice = SessionReader(options_.resume).fact("note.practice") == "true";
  }
  preparing_ = std::async(std::launch::async, [this, exam, held]() mutable {
    if (held) records::use_ticket(*held, exam);
    auto setup = options_.resume.empty()
                     ? scenarios::prepare_exam(options_.scenario, exam)
                     : scenarios::prepare_exam(SessionReader(options_.resume).setup());
    if (ticket_ && options_.word) ask_for_word(*held, options_.word, setup->session);
    if (held) records::require_promised(*held, setup->session);
    if (!options_.resume.empty()) {
      begun_ = begun_so_far(options_.resume);
      desk_.bur.store(begun_->bur, std::memory_order_relaxed);
    }
    device_->prepare(*setup);
    return setup;
  });
}

MotionSource Sitting::source() const {
  const MotionSource hand = device_->source();
  return options_.practice ? MotionSource{SourceKind::practice, hand.name, hand.serial} : hand;
}

Sitting::~Sitting() {
  if (preparing_.valid()) preparing_.wait();
  if (grading_.valid()) grading_.wait();
  check_.reset();
  live_.reset();  // before the device that its servo reads
}

void Sitting::advance() {
  if (stage_ == Stage::preparing && is_ready(preparing_)) {
    setup_ = preparing_.get();
    check_ = std::make_unique<DeviceCheck>(device_->for_check(),
                                           station_stylus_kind(options_.device.name).facts.rate_hz);
    stage_ = Stage::checking;
  }
  if (stage_ == Stage::running) {
    if (device_->done()) live_->ask_to_end();
    look_where_it_is_recorded();
    if (!live_->running()) end_running();
  }
  if (stage_ == Stage::grading && is_ready(grading_)) {
    try {
      closed_ = grading_.get();
      stage_ = Stage::done;
    } catch (const DatabaseError& refusal) {
      refused(refusal.message(), refusal.refusal());
      stage_ = Stage::unsaved;
    }
  } else if (stage_ == Stage::unsaved &&
             std::chrono::steady_clock::now() - last_try_ > std::chrono::seconds(2)) {
    last_try_ = std::chrono::steady_clock::now();
    if (!has_room(path_)) return;
    try {
      save("");
    } catch (const DatabaseError& refusal) {
      refused(refusal.message(), refusal.refusal());
    }
  }
}

DeviceSight Sitting::sight() const { return check_ ? check_->sight() : last_sight_; }

std::string Sitting::new_path(const std::string& out) const {
  if (out.empty() || out.ends_with(".cavum")) return out;
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::string when(32, '\0');
  when.resize(std::strftime(when.data(), when.size(), "%Y%m%d-%H%M%S", &local));
  const std::string name = fmt::format("{}-{}-{}.cavum", file_name_of(setup_->scenario.id),
                                       file_name_of(candidate_), when);
  return (std::filesystem::path(out) / name).string();
}

void Sitting::begin() {
  last_sight_ = sight();
  check_.reset();  // from now on the servo alone reads the device
  try {
    const Vec3 tip = device_->tip_mm();
    const std::string first = options_.resume.empty() ? new_path(options_.out) : options_.resume,
                      second = new_path(options_.out_if_full);
    with_desk_ = std::make_unique<WithDesk>(device_->for_exam(), desk_);
    if (options_.resume.empty()) {
      auto exam =
          scenarios::start_on_first_writable_disk(first, second, [&](const std::string& path) {
            return records::begin_with_ticket(ticket_ ? &*ticket_ : nullptr, path, [&] {
              return scenarios::Exam::start(*setup_, path, tip);
            });
          });
      live_ = std::make_unique<scenarios::LiveExam>(*setup_, std::move(exam), *with_desk_);
    } else {
      const bool remembered = records::require_not_closed(setup_->session.notes, first);
      auto exam = scenarios::Exam::resume(*setup_, first, {source(), remembered, device_->notes()});
      exam->set_second_path(second);
      live_ = std::make_unique<scenarios::LiveExam>(*setup_, std::move(exam), *with_desk_);
    }
    path_ = first;
    look_where_it_is_recorded();
    live_->start();
  } catch (...) {
    live_.reset();
    check_ = std::make_unique<DeviceCheck>(device_->for_check(),
                                           station_stylus_kind(options_.device.name).facts.rate_hz);
    throw;
  }
  stage_ = Stage::running;
}

void Sitting::look_where_it_is_recorded() {
  constexpr auto k_told_for = std::chrono::seconds(20);
  const auto now = std::chrono::steady_clock::now();
  const std::string at = live_->session();
  if (at != path_) {
    moved_ =
        msg("{} cannot be written: its disk is full or refuses. The whole exam is recorded at {}.",
            path_, at);
    moved_at_ = now;
    path_ = at;
  }
  if (!moved_.empty() && now - moved_at_ > k_told_for) moved_ = {};
}

void Sitting::stop() {
  if (stage_ == Stage::running) end_running();
}

void Sitting::rescue() {
  stop();
  for (int tries = 0;; ++tries) {
    while (stage_ == Stage::grading) {
      grading_.wait();
      advance();
    }
    if (stage_ != Stage::unsaved) return;
    if (tries == 2)
      throw Error(Name{path_}, msg("cannot be written, nor can any other place"),
                  msg("what was on disk before can be resumed from there"));
    try {
      save(tries == 0 ? "" : scenarios::rescue_path(path_));
    } catch (const DatabaseError& refusal) {
      refused(refusal.message(), refusal.refusal());
    }
  }
}

double Sitting::exam_s() {
  if (stage_ != Stage::running) return 0.0;
  const scenarios::LiveView view = live_->view();
  return static_cast<double>(view.ticks - view.paused_ticks) * k_tick_s;
}

ui::SoundParameters Sitting::sound() {
  if (stage_ != Stage::running) return {};
  const scenarios::LiveView view = live_->view();
  return {.rpm = view.output.rpm,
          .load_n = length(view.output.rendered_force_n),
          .cutting = view.output.cutting,
          .enamel_share = view.enamel_share,
          .dentin_share = view.dentin_share,
          .spray = view.output.rpm > 0.0 ? 1.0 : 0.0,
          .suction = 1.0};
}

void Sitting::ask_to_end() {
  if (live_) live_->ask_to_end();
}

void Sitting::note(Event event) {
  if (stage_ == Stage::running) live_->note(std::move(event));
}

void Sitting::end_running() {
  report_ = live_->finish();
  path_ = live_->exam().recorder().path();
  if (live_->exam().over()) return close_exam();
  trouble_ = why_stopped();
  stage_ = Stage::interrupted;
  if (unwritten_s() <= 0.0) return;
  refused(report_.writer.error, report_.writer.refusal);
  stage_ = Stage::unsaved;
}

Message Sitting::why_stopped() const {
  return report_.servo.failure.empty() ? msg("the servo was stopped") : report_.servo.failure;
}

void Sitting::close_exam() {
  grading_ = std::async(std::launch::async, [this] {
    grading::ClosedExam closed = grading::grade_and_close(live_->exam());
    records::remember_closed(closed.graded->session.notes, live_->exam().recorder().path());
    lessons_ = grading::lessons(closed.graded->input(), closed.result);
    return closed;
  });
  stage_ = Stage::grading;
}

double Sitting::unwritten_s() const {
  const Recorder& recorder = live_->exam().recorder();
  return static_cast<double>(recorder.ticks() - recorder.ticks_on_disk()) * k_tick_s;
}

void Sitting::save(const std::string& place) {
  scenarios::Exam& exam = live_->exam();
  if (!place.empty()) {
    const std::filesystem::path wanted(place);
    const auto file = std::filesystem::is_directory(wanted)
                          ? wanted / std::filesystem::path(path_).filename()
                          : wanted;
    if (file.extension() != ".cavum")
      throw Error(Name{place}, msg("is neither a folder nor a session file"),
                  msg("name a folder, or a new file ending in .cavum"));
    exam.recorder().move_to(file.string(), refusal_);
  }
  exam.recorder().flush();
  path_ = exam.recorder().path();
  if (exam.over()) return close_exam();
  trouble_ = why_stopped();
  stage_ = Stage::interrupted;
}

}  // namespace cavum::station
