#include "engine/device/hardware/open_stylus.h"

#include <chrono>
#include <thread>

#include "engine/device/device_error.h"

namespace cavum {

std::vector<StylusInfo> list_styluses(bool begin, const StylusKinds& kinds) {
  std::vector<StylusInfo> found;
  for (const auto& kind : kinds.all()) {
    if (!kind.look) continue;
    StylusLook look;
    try {
      look = kind.look(load_station_stylus(kind), begin);
    } catch (const Error& e) {
      look.problem = e;  // the station's file
    }
    found.push_back({.id = kind.facts.id,
                     .name = kind.facts.name,
                     .there = look.there,
                     .problem = look.problem});
  }
  return found;
}

std::unique_ptr<Stylus> open_stylus(const std::string& wanted, const StylusOptions& options,
                                    const StylusKinds& kinds) {
  return kinds.at(wanted, msg("stylus '{}'", wanted), {StylusHand::candidate, StylusHand::person})
      .open(options);
}

std::unique_ptr<Stylus> open_stylus(const std::string& wanted) {
  const StylusKind& kind = stylus_kinds().at(wanted, msg("stylus '{}'", wanted),
                                             {StylusHand::candidate, StylusHand::person});
  StylusOptions options;
  options.station = load_station_stylus(kind);
  return kind.open(options);
}

Pose first_pose(Stylus& stylus, double patience_s) {
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::duration<double>(patience_s);
  constexpr double k_look_s = 0.001;
  for (;;) {
    const DeviceReading reading = stylus.read(k_look_s);
    stylus.send_force({});
    if ((reading.flags & k_stylus_fresh) != 0 && !stylus.health().problem) return reading.pose;
    if (Clock::now() >= until) break;
    std::this_thread::sleep_for(std::chrono::duration<double>(k_look_s));
  }
  if (const std::optional<Error> problem = stylus.health().problem) throw Error(*problem);
  throw stylus_error(stylus.facts().id, DeviceError::no_position, msg("gives no position"),
                     msg("see `cavum devices`"));
}

}  // namespace cavum
