// Which pedal this station has and how its numbers become a position: made by `cavum devices
// --calibrate-pedal`, kept in the station's own folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/message.h"
#include "engine/device/pedal.h"

namespace cavum {

struct StationPedal {
  std::uint16_t vendor = 0, product = 0;  ///< of USB
  PedalCalibration calibration;
};

/// "068e:00f2" in numbers. Throws Error at `where` for anything else.
void parse_usb_id(const std::string& text, const Message& where, std::uint16_t& vendor,
                  std::uint16_t& product);
[[nodiscard]] std::string usb_id(std::uint16_t vendor, std::uint16_t product);

/// station_path("pedal.toml").
[[nodiscard]] std::string station_pedal_path();
/// Throws Error on a file that is no such text: `id`, `axis` 0..63, `released`, `pressed`
/// (unequal), `speaks_on_change`.
[[nodiscard]] StationPedal parse_station_pedal(const std::string& text, const std::string& where);
/// The station's pedal, or nothing when it has none yet. Throws Error when the file is damaged.
[[nodiscard]] std::optional<StationPedal> load_station_pedal(const std::string& path);
/// What parse_station_pedal reads.
[[nodiscard]] std::string to_toml(const StationPedal& pedal);

/// What a foot that was first off the pedal and then pressed it down leaves of each axis.
struct AxisReceived {
  std::int32_t released = 0;  ///< median with the foot off
  std::int32_t pressed = 0;   ///< median with the pedal down
  std::int32_t jitter = 0;    ///< range of the numbers with the foot off
  std::int64_t reports = 0;
};
/// The axis that moved by the largest share of its range, and its ends drawn in by the jitter and a
/// fiftieth of the way, so that a pedal released rests at 0. Throws Error when no axis moved by a
/// tenth of its range.
[[nodiscard]] PedalCalibration calibrate_pedal(const std::vector<AxisReceived>& axes,
                                               const std::vector<std::int64_t>& ranges,
                                               bool speaks_on_change);

}  // namespace cavum
