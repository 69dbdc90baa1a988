// `station`: the exam window.
#include <termios.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/write_file.h"
#include "engine/session/session_reader.h"
#include "grading/records/ledger_key.h"
#include "grading/records/station_ticket.h"
#include "ui/cli/enrol_station.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/office/station_link.h"
#include "ui/parts/distinct_paths.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/say.h"
#include "ui/station/author.h"
#include "ui/station/station.h"
#include "ui/station/station_device.h"
#include "ui/station/station_door.h"
#include "ui/station/supervisor_code.h"

namespace cavum::ui {
namespace {

constexpr std::size_t k_longest_code = 47;

struct StationArguments {
  station::StationOptions station;
  std::string author;
  EnrolOptions enrol;
  std::string server, certificate;  ///< of the exam office
  int frame_times = 0;
  bool kiosk = false, set_code = false, no_self_check = false;
  double self_check_hours = 12.0;
  std::string code_file;  ///< of the supervisor's code; empty: the station's own
};

void require_second_path(const station::SittingOptions& o) {
  if (o.out_if_full.empty()) return;
  const std::string named = "--out-if-full " + o.out_if_full;
  std::error_code none;
  if (o.resume.empty() && std::filesystem::weakly_canonical(o.out, none) ==
                              std::filesystem::weakly_canonical(o.out_if_full, none))
    throw Error(Name{named}, msg("is the same place as --out"),
                msg("name another, on another disk"));
  if (o.out_if_full.ends_with(".cavum") && std::filesystem::exists(o.out_if_full))
    throw Error(Name{named}, msg("is there already"), msg("name another file"));
  if (!o.out_if_full.ends_with(".cavum") && !std::filesystem::is_directory(o.out_if_full))
    throw Error(Name{named}, msg("is no folder"), msg("make it, or name a file ending in .cavum"));
  require_writable(o.out_if_full.ends_with(".cavum") ? o.out_if_full
                                                     : o.out_if_full + "/session.cavum");
}

void require_sound(const station::StationOptions& o, const std::string& author) {
  if (!author.empty()) {
    if (!o.replay.empty() || !o.sitting.scenario.empty())
      throw Error(Name{"--author " + author},
                  msg("was asked for together with an exam or a replay"),
                  msg("name the scenario after --author alone"));
    return;
  }
  if (!o.replay.empty() && !o.sitting.scenario.empty())
    throw Error(Name{"--replay " + o.replay}, msg("was asked for together with a scenario"),
                msg("leave the scenario out: the session holds its own"));
  if (!o.pictures.empty() && o.script.empty())
    throw Error(Name{"--pictures " + o.pictures}, msg("has no script that takes any"),
                msg("add --script"));
  if (!o.replay.empty()) return;
  if (o.sitting.scenario.empty() && o.sitting.resume.empty())
    throw Error(msg("station"), msg("no scenario given"),
                msg("name a file such as data/scenarios/molar_access.toml"));
  if (o.sitting.device.name.empty())
    throw Error(msg("station"), msg("no device given"),
                msg("say what is in the candidate's hand: --device {}",
                    list_of(stylus_kinds().ids(
                        {StylusHand::mouse, StylusHand::person, StylusHand::candidate}))));
  if (!o.sitting.resume.empty()) {
    if (!o.sitting.scenario.empty() || !o.sitting.tickets.empty())
      throw Error(Name{"--resume " + o.sitting.resume},
                  msg("was asked for together with a scenario or tickets"),
                  msg("leave them out: the session holds its own"));
    SessionReader(o.sitting.resume).require_readable();
    require_second_path(o.sitting);
    return;
  }
  // a name that is none is refused now; what is plugged in is opened for each candidate
  if (station::station_stylus_kind(o.sitting.device.name).hand != StylusHand::person)
    static_cast<void>(station::make_station_device(o.sitting.device));
  if (o.sitting.out.ends_with(".cavum")) {
    require_distinct_paths({{"--out " + o.sitting.out, o.sitting.out}},
                           {{"", o.sitting.scenario}, {"", o.sitting.tooth}});
    if (std::filesystem::exists(o.sitting.out))
      throw Error(Name{"--out " + o.sitting.out}, msg("is there already"),
                  msg("name another file, or a folder"));
  } else if (!std::filesystem::is_directory(o.sitting.out)) {
    throw Error(Name{"--out " + o.sitting.out}, msg("is no folder"),
                msg("make it, or name a file ending in .cavum"));
  } else {
    require_writable(o.sitting.out + "/session.cavum");
  }
  require_second_path(o.sitting);
  if (o.candidate.size() > k_longest_code)
    throw Error(Name{"--candidate"}, msg("is longer than a code"),
                msg("use {} characters at most", k_longest_code));
  // what would spoil the exam is said before a candidate sits down
  scenarios::ExamOptions trial;
  trial.candidate = "trial";
  trial.tooth_file = o.sitting.tooth;
  trial.force_model = o.sitting.model;
  trial.rubric_file = o.sitting.rubric;
  trial.grant = o.sitting.grant;
  static_cast<void>(scenarios::prepare_exam(o.sitting.scenario, trial));
}

/// Typed twice at a terminal, where it does not show; the first line of anything else.
int set_code(const std::string& path) {
  const bool asks = ::isatty(STDIN_FILENO) == 1;
  termios shown{};
  if (asks) ::tcgetattr(STDIN_FILENO, &shown);
  const auto typed = [&](const std::string& what) {
    if (asks) {
      std::cerr << what << " " << std::flush;
      termios hidden = shown;
      hidden.c_lflag &= ~static_cast<tcflag_t>(ECHO);
      ::tcsetattr(STDIN_FILENO, TCSANOW, &hidden);
    }
    std::string line;
    std::getline(std::cin, line);
    if (asks) {
      ::tcsetattr(STDIN_FILENO, TCSANOW, &shown);
      std::cerr << "\n";
    }
    return line;
  };
  const std::string code = typed(tr("the supervisor's new code:"));
  if (asks && typed(tr("once more:")) != code)
    throw Error(msg("the supervisor's code"), msg("was typed differently the second time"),
                msg("begin again"));
  station::set_supervisor_code(code, path);
  say(msg("written: {}", path));
  return 0;
}

/// What a station that speaks with an office needs, and the folder of its tickets.
office::LinkOptions office_of(const StationArguments& o, station::SittingOptions& sitting) {
  if (sitting.practice || !o.station.replay.empty() || !o.author.empty())
    throw Error(Name{"--server"}, msg("was asked for with something that is no exam"),
                msg("leave one of them out"));
  office::LinkOptions link;
  link.server = o.server;
  link.certificate = o.certificate;
  link.school = records::station_school_key();
  if (link.school.empty())
    throw Error(Name{records::school_public_key_path()}, msg("this station knows no school yet"),
                msg("copy the school's public key there: `cavum ledger init` writes it"));
  if (sitting.resume.empty()) {
    if (sitting.tickets.empty()) sitting.tickets = station_path("tickets");
    make_private_folder(sitting.tickets);
  }
  link.tickets = sitting.tickets.empty() ? station_path("tickets") : sitting.tickets;
  for (const auto& place :
       {sitting.resume.empty() ? sitting.out : sitting.resume, sitting.out_if_full})
    if (!place.empty()) link.recordings.push_back(place);
  return link;
}

int run(const StationArguments& o) {
  if (!o.enrol.code.empty() || o.enrol.replace_key) {
    EnrolOptions enrol = o.enrol;
    enrol.out = o.station.sitting.out;
    enrol_station(enrol);
    return 0;
  }
  if (o.set_code)
    return set_code(o.code_file.empty() ? station::supervisor_code_path() : o.code_file);
  station::StationDoor::pass();
  station::StationOptions s = o.station;
  if (s.tutorial) {
    s.sitting.practice = true;
    if (s.sitting.scenario.empty())
      s.sitting.scenario = scenarios::find_data_file("scenarios", "class_1.toml", "");
    if (s.candidate.empty()) s.candidate = "tutorial";
  }
  if ((s.sitting.practice || o.frame_times > 0) && s.sitting.device.name.empty())
    s.sitting.device.name = "mouse";
  if (o.kiosk) {
    if (!s.replay.empty() || !o.author.empty() || s.sitting.practice)
      throw Error(Name{"--kiosk"}, msg("was asked for with something that is no exam"),
                  msg("leave one of them out"));
    s.supervisor_hash = station::read_supervisor_code(
        o.code_file.empty() ? station::supervisor_code_path() : o.code_file);
  }
  if (!o.server.empty()) s.office = office_of(o, s.sitting);
  if (!o.no_self_check && s.replay.empty()) s.self_check_hours = o.self_check_hours;
  require_sound(s, o.author);
  if (!o.author.empty()) return station::run_author(s, o.author);
  if (o.frame_times == 0) return station::run_station(s);
  station::print_frame_times(s, o.frame_times);
  return 0;
}

void add_places(CLI::App* station, station::StationOptions& s) {
  station->add_option("scenario", s.sitting.scenario, tr("scenario file (.toml)"));
  station
      ->add_option("--out", s.sitting.out,
                   tr("folder for the sessions, or one session file (.cavum)"))
      ->capture_default_str();
  station->add_option(
      "--out-if-full", s.sitting.out_if_full,
      tr("the same on another disk: begins or goes on there when --out cannot be written"));
  station->add_option("--replay", s.replay, tr("look at a recorded exam instead"));
  station->add_option("--resume", s.sitting.resume,
                      tr("go on with an exam that was interrupted: its session file"));
}

void add_device(CLI::App* station, station::StationOptions& s) {
  station->add_option(
      "--device", s.sitting.device.name,
      tr("what is in the candidate's hand: {}; with --practice mouse unless another is named",
         list_of(
             stylus_kinds().ids({StylusHand::candidate, StylusHand::mouse, StylusHand::person}))));
  station
      ->add_option(
          "--operator", s.sitting.device.operator_name,
          tr("of the simulated device: expert, novice, perforator, student-0 to student-100, careless"))
      ->capture_default_str();
  station->add_option("--seed", s.sitting.device.seed, tr("of the simulated candidate's habits"))
      ->check(seed_check())
      ->capture_default_str();
}

void add_candidate(CLI::App* station, station::StationOptions& s) {
  auto* practice =
      station->add_flag("--practice", s.sitting.practice,
                        tr("tissue and target in clear colours, and a coach; the session says so"));
  station->add_flag("--tutorial", s.tutorial,
                    tr("two minutes of practice for the first time, one step after the other"));
  station
      ->add_option(
          "--tickets", s.sitting.tickets,
          tr("folder of tickets: only who has one sits, and as it promises (see `cavum ledger ticket`)"))
      ->check(existing_folder())
      ->excludes(practice);
  station->add_option("--candidate", s.candidate, tr("code that stands in the field already"));
  station->add_option("--tooth", s.sitting.tooth, tr("another tooth than the scenario's"));
  station
      ->add_option("--model", s.sitting.model,
                   tr("force model: paper, consistent, clinical, or a TOML file"))
      ->capture_default_str();
  station->add_option("--rubric", s.sitting.rubric,
                      tr("mark by this rubric (TOML) instead of the scenario's own"));
  station->add_option("--extra-time-percent", s.sitting.grant.extra_time_percent,
                      tr("extra time for this candidate, instead of the scenario's"));
  station->add_option("--extra-time-s", s.sitting.grant.extra_time_s,
                      tr("the same in seconds; both add up"));
}

void add_office(CLI::App* station, StationArguments& o) {
  auto* server = station->add_option(
      "--server", o.server,
      tr("address of the exam office, such as https://office:8443: tickets come from there, the board there shows this "
         "station, and exams are handed in by themselves"));
  station
      ->add_option(
          "--certificate", o.certificate,
          tr("the office's own certificate (PEM), where it is not one that this computer trusts"))
      ->check(existing_file())
      ->needs(server);
}

void add_window(CLI::App* station, station::StationOptions& s) {
  station->add_flag("--left-handed", s.left_handed,
                    tr("layout for the left hand; can be chosen at sign-in, too"));
  station->add_flag("--high-contrast", s.high_contrast,
                    tr("black, white and yellow; can be chosen at sign-in, too"));
  station->add_option("--text-scale", s.text_scale, tr("size of the text, 0.8 to 1.8"))
      ->check(between(0.8, 1.8))
      ->capture_default_str();
  station
      ->add_option(
          "--effects", s.effects,
          tr("of the picture, 0 (richest) to 5; without it, as the computer keeps up with"))
      ->check(between(0, 5));
  station->add_option("--monitor", s.monitor,
                      tr("where the window opens: a monitor's number, from 1, or its name"));
  station->add_option("--width", s.width, tr("of the window, pixels"))
      ->check(between(640, 7680))
      ->capture_default_str();
  station->add_option("--height", s.height, tr("of the window, pixels"))
      ->check(between(480, 4320))
      ->capture_default_str();
}

void add_lock(CLI::App* station, StationArguments& o) {
  station->add_flag(
      "--kiosk", o.kiosk,
      tr("locked: fills the screen, and only the supervisor's code closes it; what is tried is recorded"));
  station->add_option(
      "--supervisor-code", o.code_file,
      tr("file with the hash of the supervisor's code, instead of the station's own"));
  station->add_flag("--set-supervisor-code", o.set_code,
                    tr("ask for the supervisor's code, and keep its hash"));
}

void add_script(CLI::App* station, station::StationOptions& s, int& frame_times) {
  station->add_option("--script", s.script,
                      tr("press the keys that this file lists (for demonstrations and tests)"));
  station->add_option("--pictures", s.pictures,
                      tr("folder for the pictures that the script takes"));
  station
      ->add_option("--frame-times", frame_times,
                   tr("only draw the tooth so many times, and print how long it takes"))
      ->check(between(1, 100000));
}

void add_enrolment(CLI::App* station, EnrolOptions& enrol) {
  station->add_option(
      "--enrol", enrol.code,
      tr("ask the school to enrol this station, with the one-time code that it gave; --out is the request to write"));
  station->add_flag(
      "--replace-key", enrol.replace_key,
      tr("make a new key for this enrolled station, and ask for it to take the old one's place; --out as above"));
  station
      ->add_option(
          "--stylus", enrol.styluses,
          tr("with --enrol or --replace-key: only recordings of this stylus count then; may be repeated"))
      ->type_name(fmt::format("{}", fmt::join(stylus_kinds().ids({StylusHand::person}), "|")));
}

}  // namespace

void add_station_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<StationArguments>();
  station::StationOptions& s = o->station;
  s.sitting.out = ".";
  auto* station = app.add_subcommand(
      "station", tr("The exam window: sign-in, check of the devices, briefing, exam, result"));
  add_places(station, s);
  station->add_option(
      "--author", o->author,
      tr("change the zones of this scenario by hand, with everything `scenario check` says beside them"));
  add_device(station, s);
  station
      ->add_option(
          "--self-check-hours", o->self_check_hours,
          tr("before an exam a real stylus is checked when its last check is older, 0 to 1000"))
      ->check(between(0.0, 1000.0))
      ->capture_default_str();
  station->add_flag("--no-self-check", o->no_self_check,
                    tr("check no stylus; the session then has the last check, however old"));
  add_candidate(station, s);
  add_window(station, s);
  add_lock(station, *o);
  add_office(station, *o);
  add_script(station, s, o->frame_times);
  add_enrolment(station, o->enrol);
  station->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace cavum::ui
