// Finds and opens the stylus that is asked for by name, and says what stands in the way when it
// cannot: not plugged in, no permission (with the udev rule to add), no driver library, no
// firmware, no service.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/device/hardware/stylus_kind.h"

namespace cavum {

/// What was found of one kind of stylus.
struct StylusInfo {
  std::string id;
  Message name;
  bool there = false;
  std::optional<Error> problem = {};  ///< why it cannot be opened
};
/// Of all kinds but the mouse, in the order of the table. Opens none for longer than a look; with
/// `begin` drivers may be begun, which not every one likes again and again.
[[nodiscard]] std::vector<StylusInfo> list_styluses(bool begin = true,
                                                    const StylusKinds& kinds = stylus_kinds());

/// Opens `wanted`. One that may be plugged in later, and again, is opened without: see its health.
/// Throws Error on a name that is none, naming what there is, or when it can never work as it
/// stands (no library, no firmware, no permission).
[[nodiscard]] std::unique_ptr<Stylus> open_stylus(const std::string& wanted,
                                                  const StylusOptions& options,
                                                  const StylusKinds& kinds = stylus_kinds());
/// With what this station keeps of it: load_station_stylus.
[[nodiscard]] std::unique_ptr<Stylus> open_stylus(const std::string& wanted);

/// Where the tip is, tooth frame: waits until the stylus is ready, for `patience_s` at most. For
/// the thread that will give it to the servo. Throws Error with its problem when time is up.
[[nodiscard]] Pose first_pose(Stylus& stylus, double patience_s);

}  // namespace cavum
