// What this station keeps of a stylus: how it stands beside the tooth, and what its driver must be told. Made by `cavum devices --place`; one file
// a kind of stylus in the station's own folder.
#pragma once

#include <string>

#include "engine/device/placement.h"

namespace cavum {

struct StationStylus {
  Placement placement;
  std::string firmware;              ///< Falcon: file with its firmware; empty: $CAVUM_FALCON_FIRMWARE
  double arm_offset_deg = 35.0;      ///< Falcon: angle of the arms at encoder 0; sources say 35 to 50
  std::string library = "libHD.so";  ///< OpenHaptics: the library to load
  std::string device_name;           ///< OpenHaptics: the name given in its own setup; empty: the default device
};

/// station_path("stylus-ID.toml").
[[nodiscard]] std::string station_stylus_path(const std::string& id);
/// The placement that is meant when nobody has made one: the device in front of the candidate, its middle at the crown's.
[[nodiscard]] StationStylus usual_station_stylus(const std::string& id);
/// Throws Error on a file that is no such text: `rotation` and `tool` (w, x, y, z; not all 0), `offset_mm` (x, y, z within 1 m), and optionally
/// `firmware`, `arm_offset_deg` 0..90, `library`, `device_name`.
[[nodiscard]] StationStylus parse_station_stylus(const std::string& text, const std::string& where);
/// What the station keeps, or the usual. Throws Error when the file is damaged.
[[nodiscard]] StationStylus load_station_stylus(const std::string& id);
/// What parse_station_stylus reads.
[[nodiscard]] std::string to_toml(const StationStylus& stylus);

}  // namespace cavum
