// What this station keeps of a stylus: how it stands beside the tooth, and what its driver must be
// told. Made by `cavum devices --place`; one file a kind of stylus in the station's own folder.
#pragma once

#include <map>
#include <string>
#include <variant>

#include "engine/device/placement.h"

namespace cavum {

struct StylusKind;

/// A number or a text.
using StylusValue = std::variant<double, std::string>;

/// One thing that a driver must be told, with the value that is meant when the station says
/// nothing.
struct StylusSetting {
  std::string key;
  StylusValue usual;
  double least = 0.0, most = 0.0;  ///< of a number
};

struct StationStylus {
  Placement placement;
  std::map<std::string, StylusValue> settings;  ///< all that its kind has, by key

  /// Throws Error for a key that this kind of stylus has not, or of the other type.
  [[nodiscard]] double number(const std::string& key) const;
  [[nodiscard]] const std::string& text(const std::string& key) const;
};

/// station_path("stylus-ID.toml").
[[nodiscard]] std::string station_stylus_path(const std::string& id);
/// What is meant when nobody has placed it: the kind's own.
[[nodiscard]] StationStylus usual_station_stylus(const StylusKind& kind);
/// Throws Error on a file that is no such text: `rotation` and `tool` (w, x, y, z; not all 0),
/// `offset_mm` (x, y, z within 1 m), and optionally the settings of `kind`, each in its range.
[[nodiscard]] StationStylus parse_station_stylus(const std::string& text, const std::string& where,
                                                 const StylusKind& kind);
/// What the station keeps, or the usual. Throws Error when the file is damaged.
[[nodiscard]] StationStylus load_station_stylus(const StylusKind& kind);
/// What parse_station_stylus reads.
[[nodiscard]] std::string to_toml(const StationStylus& stylus);

}  // namespace cavum
