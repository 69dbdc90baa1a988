#include "engine/device/hardware/open_stylus.h"

#include <chrono>
#include <thread>

#include "engine/base/error.h"
#include "engine/device/hardware/falcon_stylus.h"
#include "engine/device/hardware/openhaptics_stylus.h"

namespace cavum {
namespace {

std::unique_ptr<Stylus> open_simulated(const StylusOptions& options) {
  if (options.hand) return std::make_unique<SimulatedStylus>(OmniModel{}, HandModel{}, k_tick_s, options.hand);
  const HandModel nobody{.mass_kg = 0.0, .stiffness_n_per_mm = 0.0, .damping_n_s_per_mm = 0.0};
  return std::make_unique<SimulatedStylus>(OmniModel{}, nobody, k_tick_s, [at = options.free_at_mm](double) { return HandIntent{at, 0.0}; });
}

std::string found_words(const std::vector<StylusInfo>& found) {
  std::string words;
  for (const auto& info : found) words += (words.empty() ? "" : "; ") + info.id + ": " + (info.there ? info.name : "not there");
  return words;
}

/// A problem is the text of an Error already.
[[noreturn]] void throw_problem(const std::string& problem) {
  const auto what = problem.find(": ") + 2, todo = problem.rfind("; ");
  throw Error(problem.substr(0, what - 2), problem.substr(what, todo - what), problem.substr(todo + 2));
}

}  // namespace

std::vector<StylusInfo> list_styluses(bool begin_touch) {
  std::vector<StylusInfo> found{{.id = "simulated", .name = "simulated Omni in a simulated hand", .there = true, .problem = {}}};
  StylusInfo falcon{.id = "falcon", .name = falcon_facts().name, .there = false, .problem = {}};
  falcon.problem = falcon_problem(falcon.there);
  found.push_back(falcon);
  StylusInfo touch{.id = "touch", .name = "Touch or PHANTOM Omni through OpenHaptics", .there = false, .problem = {}};
  try {
    touch.problem = openhaptics_problem(load_station_stylus("touch"), touch.there, begin_touch);
  } catch (const Error& e) {
    touch.problem = e.what();  // the station's file
  }
  found.push_back(touch);
  return found;
}

std::unique_ptr<Stylus> open_stylus(const std::string& wanted, const StylusOptions& options) {
  if (wanted == "simulated") return open_simulated(options);
  if (wanted == "falcon") {
    bool there = false;
    if (const std::string problem = falcon_problem(there); there && !problem.empty()) throw_problem(problem);
    return std::make_unique<FalconStylus>(options.station);
  }
  if (wanted == "touch") return std::make_unique<OpenHapticsStylus>(options.station);
  throw Error("stylus '" + wanted + "'", "is not known (" + found_words(list_styluses(false)) + ")",
              "name one of simulated, falcon, touch; `cavum devices` lists what is there");
}

std::unique_ptr<Stylus> open_stylus(const std::string& wanted) {
  StylusOptions options;
  options.station = load_station_stylus(wanted);
  return open_stylus(wanted, options);
}

Pose first_pose(Stylus& stylus, double patience_s) {
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::duration<double>(patience_s);
  constexpr double k_look_s = 0.001;
  for (;;) {
    const DeviceReading reading = stylus.read(k_look_s);
    stylus.send_force({});
    if ((reading.flags & k_stylus_fresh) != 0 && stylus.health().ready) return reading.pose;
    if (Clock::now() >= until) break;
    std::this_thread::sleep_for(std::chrono::duration<double>(k_look_s));
  }
  const std::string problem = stylus.health().problem;
  throw_problem(problem.empty() ? "stylus " + stylus.facts().id + ": gives no position; see `cavum devices`" : problem);
}

}  // namespace cavum
