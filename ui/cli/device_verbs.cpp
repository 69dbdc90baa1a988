// `cavum devices`: the foot pedals and styluses that are plugged in, what is wrong with them, how
// well they speak, and their calibration.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/base/file.h"
#include "engine/base/order.h"
#include "engine/device/device_error.h"
#include "engine/device/hardware/hid_pedal.h"
#include "engine/device/hardware/station_pedal.h"
#include "engine/device/hardware/stylus_kind.h"
#include "engine/device/selfcheck/check_history.h"
#include "ui/cli/self_check_verb.h"
#include "ui/cli/stylus_devices.h"
#include "ui/cli/verbs.h"
#include "ui/language/say.h"
#include "ui/parts/interrupt.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"
#include "ui/parts/terminal.h"

namespace cavum::ui {
namespace {

struct DeviceArguments {
  bool json = false, test = false, calibrate = false, live = false, place = false, no_push = false,
       self_check = false, history = false;
  std::string id, stylus, new_history, go_on, station_name;
  double seconds = 3.0;
};

/// The one that `id` names, or the only one there is.
HidPedalInfo chosen(const std::vector<HidPedalInfo>& pedals, const std::string& id) {
  List names;
  for (const auto& p : pedals) {
    if (p.id() == id) return p;
    names.items.emplace_back(Name{p.id()});
  }
  if (pedals.empty())
    throw Error(DeviceError::not_there, msg("devices"), msg("no foot pedal is plugged in"),
                msg("plug one in; a USB pedal is seen within a second"));
  if (!id.empty())
    throw Error(DeviceError::not_there, Name{"--pedal " + id}, msg("is not plugged in"),
                msg("name one of {}", names));
  if (pedals.size() > 1)
    throw Error(DeviceError::several, msg("devices"), msg("there are several pedals"),
                msg("choose with --pedal one of {}", names));
  return pedals[0];
}

std::int32_t median_or_0(const std::vector<std::int32_t>& numbers) {
  return numbers.empty() ? 0 : median(numbers);
}

/// Smallest difference between two numbers that were heard; 0 when all were the same.
std::int32_t quantum_of(std::vector<std::int32_t> numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::int32_t least = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i)
    if (const std::int32_t step = numbers[i] - numbers[i - 1]; least == 0 || step < least)
      least = step;
  return least;
}

nlohmann::json axis_json(const HidField& axis) {
  return {{"page", axis.page},
          {"usage", axis.usage},
          {"bits", axis.bits},
          {"least", axis.least},
          {"most", axis.most}};
}

void list(const DeviceArguments& o) {
  if (!o.id.empty()) {
    std::uint16_t vendor = 0, product = 0;
    parse_usb_id(o.id, Name{"--pedal"}, vendor, product);
  }
  const auto pedals = list_hid_pedals();
  std::optional<Error> calibration_problem;
  std::optional<StationPedal> station;
  try {
    station = load_station_pedal(station_pedal_path());
  } catch (const Error& e) {
    calibration_problem = e;
  }
  const auto calibrated = [&station](const HidPedalInfo& p) {
    return station && station->vendor == p.vendor && station->product == p.product;
  };
  if (o.json) {
    nlohmann::json all = nlohmann::json::array();
    for (const auto& p : pedals) {
      nlohmann::json axes = nlohmann::json::array();
      for (const auto& axis : p.axes) axes.push_back(axis_json(axis));
      all.push_back({{"id", p.id()},
                     {"name", p.name},
                     {"path", p.path},
                     {"axes", axes},
                     {"problem", problem_json(p.problem)},
                     {"calibrated", calibrated(p)}});
    }
    print_json(nlohmann::json{{"pedals", all},
                              {"calibration_problem", problem_json(calibration_problem)},
                              {"styluses", styluses_json(o.live)}});
    return;
  }
  Lines out;
  out.add(msg("pedals"));
  for (const auto& p : pedals) {
    const auto axes = static_cast<std::int64_t>(p.axes.size());
    out.add(calibrated(p)
                ? msgn("{}  {}  ({}, {} axis, calibrated)", "{}  {}  ({}, {} axes, calibrated)",
                       axes, p.id(), p.name, p.path, axes)
                : msgn("{}  {}  ({}, {} axis)", "{}  {}  ({}, {} axes)", axes, p.id(), p.name,
                       p.path, axes),
            2);
    if (p.problem)
      out.add(p.problem->message(), 4);
    else if (!calibrated(p))
      out.add(msg("not calibrated; run `cavum devices --calibrate-pedal --pedal {}`", p.id()), 4);
  }
  if (pedals.empty()) out.add(msg("none; without one the handpiece stands still"), 2);
  if (station && std::none_of(pedals.begin(), pedals.end(), calibrated))
    out.add(msg("{} is calibrated for this station, and not plugged in",
                usb_id(station->vendor, station->product)),
            2);
  if (calibration_problem) out.add(calibration_problem->message(), 2);
  out.append(styluses_text(o.live));
  say(out);
  std::cout << std::flush;
}

int test(const DeviceArguments& o) {
  const HidPedalInfo pedal = chosen(list_hid_pedals(), o.id);
  if (pedal.problem) throw Error(*pedal.problem);
  if (!o.json) say(msg("move the pedal {} for {} ...", pedal.id(), as_s(o.seconds, k_as_needed)));
  std::cout << std::flush;
  const PedalHearing heard = hear_pedal(pedal.vendor, pedal.product, o.seconds);
  // Continuous enough: no silence as long as the one after which the servo no longer believes the
  // pedal.
  const bool continuous = heard.reports > 1 && heard.longest_gap_s < HidPedal::k_stale_after_s;
  const double rate_hz = heard.mean_period_s > 0 ? 1.0 / heard.mean_period_s : 0.0;
  if (o.json) {
    nlohmann::json axes = nlohmann::json::array();
    for (const auto& numbers : heard.numbers) {
      const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
      axes.push_back({{"least", numbers.empty() ? 0 : *low},
                      {"most", numbers.empty() ? 0 : *high},
                      {"quantum", quantum_of(numbers)}});
    }
    print_json(nlohmann::json{{"id", pedal.id()},
                              {"reports", heard.reports},
                              {"rate_hz", rate_hz},
                              {"jitter_ms", 1e3 * heard.jitter_s},
                              {"longest_gap_ms", 1e3 * heard.longest_gap_s},
                              {"speaks_continuously", continuous},
                              {"axes", axes}});
  } else if (heard.reports == 0) {
    say(msg("it said nothing: the handpiece would stand still"));
  } else {
    const Number rate = as_unit(rate_hz, Unit::hz),
                 jitter = as_unit(1e3 * heard.jitter_s, Unit::ms, 2),
                 gap = as_unit(1e3 * heard.longest_gap_s, Unit::ms, 1);
    say(continuous ? msg("{} reports, {}, jitter {}, longest gap {}: speaks continuously",
                         heard.reports, rate, jitter, gap)
                   : msg("{} reports, {}, jitter {}, longest gap {}: speaks when it moves",
                         heard.reports, rate, jitter, gap));
    for (std::size_t i = 0; i < heard.numbers.size(); ++i) {
      const auto& numbers = heard.numbers[i];
      if (numbers.empty()) continue;
      const auto [low, high] = std::minmax_element(numbers.begin(), numbers.end());
      say(msg("axis {}: {} to {}, quantum {}", i, *low, *high, quantum_of(numbers)), 2);
    }
  }
  return heard.reports > 0 ? 0 : 1;
}

void calibrate(const DeviceArguments& o) {
  const HidPedalInfo pedal = chosen(list_hid_pedals(), o.id);
  if (pedal.problem) throw Error(*pedal.problem);
  const std::string path = station_pedal_path();
  make_private_folder(std::filesystem::path(path).parent_path().string());
  require_writable(path);
  const auto listen = [&](const std::string& what) {
    std::cerr << what << "\n";
    std::string line;
    std::getline(std::cin, line);
    return hear_pedal(pedal.vendor, pedal.product, o.seconds);
  };
  const PedalHearing off = listen(tr("take the foot off the pedal for {}, then press Enter",
                                     as_s(o.seconds, k_as_needed))),
                     down = listen(tr("press the pedal down and hold it for {}, then press Enter",
                                      as_s(o.seconds, k_as_needed)));
  if (off.reports + down.reports == 0)
    throw Error(DeviceError::silent, msg("pedal {}", pedal.id()), msg("said nothing"),
                msg("press it a few times to wake it, and begin again"));
  std::vector<AxisReceived> axes(down.numbers.size());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto& silent = off.numbers[i].empty()
                             ? down.numbers[i]
                             : off.numbers[i];  // one that speaks on change may say nothing at rest
    axes[i].released =
        off.numbers[i].empty() && !silent.empty() ? silent.front() : median_or_0(silent);
    axes[i].pressed = median_or_0(down.numbers[i]);
    if (!off.numbers[i].empty()) {
      const auto [low, high] = std::minmax_element(off.numbers[i].begin(), off.numbers[i].end());
      axes[i].jitter = *high - *low;
    }
    axes[i].reports = static_cast<std::int64_t>(down.numbers[i].size());
  }
  // Continuous only when it spoke all the time while the foot lay still.
  const bool continuous =
      off.reports > 1 && down.reports > 1 &&
      std::max(off.longest_gap_s, down.longest_gap_s) < HidPedal::k_stale_after_s;
  const StationPedal made{.vendor = pedal.vendor,
                          .product = pedal.product,
                          .calibration = calibrate_pedal(axes, down.ranges, !continuous)};
  write_private_text_file(path, to_toml(made));
  const auto& c = made.calibration;
  say(continuous ? msg("axis {}, released {}, pressed {}, speaks continuously", c.axis, c.released,
                       c.pressed)
                 : msg("axis {}, released {}, pressed {}, speaks when it moves", c.axis, c.released,
                       c.pressed));
  say(msg("written: {}", path));
}

/// The list anew twice a second, until Ctrl-C.
void watch(const DeviceArguments& o) {
  const Interrupt interrupt;
  while (!Interrupt::asked()) {
    if (::isatty(STDOUT_FILENO) == 1) command_terminal("\033[H\033[2J");
    list(o);
    if (!o.json) std::cout << "\n";
    for (int i = 0; i < 25 && !Interrupt::asked(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

}  // namespace

void add_device_verbs(CLI::App& app, int& exit_code) {
  const auto o = std::make_shared<DeviceArguments>();
  auto* devices = app.add_subcommand("devices", tr("What is plugged in and what is wrong with it"));
  devices->add_option(
      "--pedal", o->id,
      tr("vendor and product, for example 068e:00f2; needed when there are several"));
  auto* stylus = devices->add_option(
      "--stylus", o->stylus,
      tr("{}: for --test, --self-check and --place",
         list_of(stylus_kinds().ids({StylusHand::person, StylusHand::candidate}))));
  auto* test_flag = devices->add_flag(
      "--test", o->test,
      tr("listen to the pedal: rate, jitter, longest gap, quantum; ends with 1 when it is silent. With --stylus: the same, "
         "and friction in air"));
  devices
      ->add_flag("--no-push", o->no_push,
                 tr("with --test --stylus: leave out the friction, which needs gentle pushes"))
      ->needs(test_flag)
      ->needs(stylus);
  devices
      ->add_flag(
          "--place", o->place,
          tr("touch four marks, so that the stylus stands where the tooth is; kept for this station"))
      ->needs(stylus)
      ->excludes(test_flag);
  auto* self_flag =
      devices
          ->add_flag(
              "--self-check", o->self_check,
              tr("let go of the stylus: friction, strength, step and rate in a minute, held against this station's earlier checks; "
                 "ends with 1 when something changed"))
          ->excludes(test_flag);
  devices->add_flag("--history", o->history, tr("with --self-check: only what was kept"))
      ->needs(self_flag);
  const auto* anew =
      devices
          ->add_option(
              "--new-history", o->new_history,
              tr("with --self-check: why earlier checks no longer count, such as a repair"))
          ->needs(self_flag);
  const auto* go_on =
      devices
          ->add_option(
              "--override-check", o->go_on,
              tr("with --self-check: why exams go on with what the last check found; checks nothing"))
          ->needs(self_flag);
  devices->add_option("--station-name", o->station_name,
                      tr("name this station, as checks and sessions shall say it"));
  devices->add_flag("--live", o->live, tr("the list again twice a second, until Ctrl-C"))
      ->excludes(test_flag);
  devices
      ->add_flag("--calibrate-pedal", o->calibrate,
                 tr("find the axis and its ends, and keep them for this station"))
      ->excludes(test_flag);
  devices->add_option("--seconds", o->seconds, tr("how long to listen, 0.2 to 600"))
      ->check(between(0.2, 600.0))
      ->capture_default_str();
  devices->add_flag("--json", o->json, tr("one JSON object on standard output"));
  devices->callback([o, anew, go_on, &exit_code] {
    exit_code = 0;
    for (const CLI::Option* option : {anew, go_on})
      if (option->count() > 0 && option->as<std::string>().empty())
        throw Error(Name{option->get_name()}, msg("gives no reason"),
                    msg("say what was done, or why"));
    if (!o->station_name.empty()) set_station_name(o->station_name);
    if (o->self_check)
      exit_code = self_check({o->stylus, o->new_history, o->go_on, o->history, o->json});
    else if (o->place)
      place_stylus(o->stylus);
    else if (o->test && !o->stylus.empty())
      exit_code = test_stylus(o->stylus, o->seconds, !o->no_push, o->json);
    else if (!o->stylus.empty())
      throw Error(Name{"--stylus " + o->stylus}, msg("says of which, but not what"),
                  msg("add --test, --self-check or --place"));
    else if (o->live)
      watch(*o);
    else if (o->calibrate)
      calibrate(*o);
    else if (o->test)
      exit_code = test(*o);
    else
      list(*o);
  });
}

}  // namespace cavum::ui
