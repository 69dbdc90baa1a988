// Finds and opens the stylus that is asked for by name, and says what stands in the way when it cannot: not plugged in, no permission (with the
// udev rule to add), no driver library, no firmware.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/device/hardware/station_stylus.h"
#include "engine/device/simulated_stylus.h"
#include "engine/device/stylus.h"

namespace cavum {

struct StylusOptions {
  StationStylus station;                       ///< placement and settings of this station
  std::function<HandIntent(double t_s)> hand;  ///< of the simulated one; empty: nobody holds it, it lies free
  Vec3 free_at_mm{0, 0, 20};                   ///< where it lies then, tooth frame
};

/// What was found of one kind of stylus.
struct StylusInfo {
  std::string id, name;
  bool there = false;
  std::string problem;  ///< why it cannot be opened, and what to do; empty when it can
};
/// The three kinds: `simulated`, `falcon`, `touch`. Opens none for longer than a look; `touch` only with `begin_touch`, for its driver does not like
/// to be begun again and again: otherwise its library alone counts.
[[nodiscard]] std::vector<StylusInfo> list_styluses(bool begin_touch = true);

/// Opens `wanted`, one of those names. A Falcon may be plugged in later, and again: see its health. Throws Error on another name, naming what there
/// is, or when it can never work as it stands (no library, no firmware, no permission).
[[nodiscard]] std::unique_ptr<Stylus> open_stylus(const std::string& wanted, const StylusOptions& options);
/// With what this station keeps of it: load_station_stylus(wanted).
[[nodiscard]] std::unique_ptr<Stylus> open_stylus(const std::string& wanted);

/// Where the tip is, tooth frame: waits until the stylus is ready, for `patience_s` at most. For the thread that will give it to the servo.
/// Throws Error with its problem when time is up.
[[nodiscard]] Pose first_pose(Stylus& stylus, double patience_s);

}  // namespace cavum
