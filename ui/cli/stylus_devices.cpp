#include "ui/cli/stylus_devices.h"

#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "engine/base/fact.h"
#include "engine/base/file.h"
#include "engine/device/device_error.h"
#include "engine/device/hardware/open_stylus.h"
#include "engine/device/hardware/stylus_probe.h"
#include "ui/language/say.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

bool placed(const std::string& id) { return ::access(station_stylus_path(id).c_str(), F_OK) == 0; }

constexpr double k_patience_s = 10.0;

const StylusKind& kind_of(const std::string& id) {
  return stylus_kinds().at(id, Name{"--stylus " + id}, {StylusHand::candidate, StylusHand::person});
}

nlohmann::json ratings(const std::string& id) {
  const StylusFacts& f = kind_of(id).facts;
  return {{"peak_n", f.peak_n},
          {"continuous_n", f.continuous_n},
          {"rate_hz", f.rate_hz},
          {"reach_mm", f.reach_mm},
          {"direction", f.measures_direction}};
}

/// A crown at the edge of what the device reaches is cut short by it, not by the tooth.
void warn_of_the_edge(const StylusKind& kind, const Placement& placed) {
  const Vec3 usual_middle_mm =
      rotation(kind.placement.rotation).transposed(-kind.placement.offset_mm);
  const double off_mm = length(to_tooth(placed, usual_middle_mm).tip_mm);
  constexpr double k_tooth_mm = 15.0;
  if (off_mm + k_tooth_mm > kind.facts.reach_mm)
    say(msg(
        "the crown is {} from the middle of its reach of {}: move the device, and place it anew",
        as_mm(off_mm, 0), as_mm(kind.facts.reach_mm, 0)));
}

/// Where the tip is, in the mean of a fifth of a second: hands tremble.
Vec3 held_at(Stylus& stylus) {
  constexpr int k_looks = 100;
  Vec3 sum;
  for (int i = 0; i < k_looks; ++i) {
    sum += first_pose(stylus, k_patience_s).tip_mm;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return sum / k_looks;
}

}  // namespace

nlohmann::json problem_json(const std::optional<Error>& problem) {
  if (!problem) return nullptr;
  return Fact(problem->code().name(), {"where", "what", "what_to_do"}, problem->message());
}

nlohmann::json styluses_json(bool again) {
  nlohmann::json all = nlohmann::json::array();
  for (const auto& s : list_styluses(!again))
    all.push_back({{"id", s.id},
                   {"name", s.name},
                   {"there", s.there},
                   {"problem", problem_json(s.problem)},
                   {"placed", placed(s.id)},
                   {"ratings", ratings(s.id)}});
  return all;
}

Lines styluses_text(bool again) {
  Lines out;
  out.add(msg("styluses"));
  for (const auto& s : list_styluses(!again)) {
    out.row({Name{s.id}, s.name, s.there ? Message() : msg("(not there)"),
             placed(s.id) ? msg("(placed)") : Message()},
            2);
    if (s.problem) out.add(s.problem->message(), 4);
  }
  return out;
}

int test_stylus(const std::string& id, double seconds, bool friction, bool json) {
  const auto stylus = open_stylus(id);
  const bool real = kind_of(id).hand == StylusHand::person;
  static_cast<void>(first_pose(*stylus, k_patience_s));
  if (!json && friction)
    say(msg("let go of the stylus and let it stand free: it is pushed slowly, by 1 N at most ..."));
  std::cout << std::flush;
  const StylusProbe p =
      probe_stylus(*stylus, {.listen_s = seconds, .friction = friction, .real_time = real});
  if (json) {
    nlohmann::json axes = nlohmann::json::object();
    const std::array<const char*, 3> names{"x", "y", "z"};
    for (std::size_t i = 0; i < 3; ++i)
      axes[names[i]] = {{"friction_n", p.axes[i].friction_n()}, {"bias_n", p.axes[i].bias_n()}};
    print_json(nlohmann::json{{"id", id},
                              {"name", stylus->facts().name},
                              {"readings", p.readings},
                              {"rate_hz", p.rate_hz},
                              {"jitter_ms", 1e3 * p.jitter_s},
                              {"longest_gap_ms", 1e3 * p.longest_gap_s},
                              {"quantum_mm", p.quantum_mm},
                              {"quantum_expected_mm", stylus->facts().position_quantum_mm},
                              {"friction_n", p.friction_n},
                              {"friction_problem", problem_json(p.friction_problem)},
                              {"axes", axes}});
  } else {
    say(msg("{}: {}, jitter {}, longest gap {}", stylus->facts().name, as_unit(p.rate_hz, Unit::hz),
            as_unit(1e3 * p.jitter_s, Unit::ms, 2), as_unit(1e3 * p.longest_gap_s, Unit::ms, 1)));
    if (p.quantum_mm > 0)
      say(msg("smallest step {} ({} are reckoned with)", as_mm(p.quantum_mm, 4),
              as_mm(stylus->facts().position_quantum_mm, k_as_needed)),
          2);
    else
      say(msg("it did not move: the step of its positions is not known"), 2);
    if (p.friction_n > 0)
      say(msg("friction in air {}; x {}, y {}, z {}; pulled by itself {} along z",
              as_n(p.friction_n), as_n(p.axes[0].friction_n()), as_n(p.axes[1].friction_n()),
              as_n(p.axes[2].friction_n()), as_n(p.axes[2].bias_n())),
          2);
    if (p.friction_problem) say(p.friction_problem->message(), 2);
  }
  return p.readings > 0 && !p.friction_problem ? 0 : 1;
}

void place_stylus(const std::string& id) {
  const StylusKind& kind =
      stylus_kinds().at(id, Name{"--place --stylus " + id}, {StylusHand::person});
  const std::string path = station_stylus_path(id);
  make_private_folder(std::filesystem::path(path).parent_path().string());
  require_writable(path);
  StylusOptions options;
  options.station = load_station_stylus(kind);
  const Quat tool = options.station.placement.tool;
  options.station.placement = {};  // its own frame
  const auto stylus = kind.open(options);
  static_cast<void>(first_pose(*stylus, k_patience_s));
  const std::array<std::pair<std::string, Vec3>, 4> marks{
      {{tr("hold the tip where the middle of the crown shall be, then press Enter"), {0, 0, 0}},
       {tr("hold the tip 20 mm to mesial (to the right) of it, then press Enter"), {20, 0, 0}},
       {tr("hold the tip 20 mm to buccal (away from you) of it, then press Enter"), {0, 20, 0}},
       {tr("hold the tip 20 mm above it, then press Enter"), {0, 0, 20}}}};
  std::vector<Vec3> device, tooth;
  for (const auto& [what, at] : marks) {
    std::cerr << what << "\n";
    std::string line;
    if (!std::getline(std::cin, line))
      throw Error(Name{"--place"}, msg("was interrupted"), msg("begin it again"));
    device.push_back(held_at(*stylus));
    tooth.push_back(at);
  }
  const PlacementFit fit = fit_placement(device, tooth);
  constexpr double k_max_mm = 3.0;
  if (fit.worst_mm > k_max_mm)
    throw Error(Name{"--place"},
                msg("the marks do not fit together: one is off by {}", as_mm(fit.worst_mm, 1)),
                msg("measure them with a ruler, and begin again"));
  options.station.placement = fit.placement;
  options.station.placement.tool = tool;
  write_private_text_file(path, to_toml(options.station));
  say(msg("marks fit within {}", as_mm(fit.worst_mm)));
  say(msg("written: {}", path));
  warn_of_the_edge(kind, fit.placement);
}

}  // namespace cavum::ui
