// Which column of a table is the time, the position, the speed, the force: by option, by our names,
// by names that machines write. Never guessed: where two could be it, both are listed.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/lab/explain/recording/header.h"
#include "engine/lab/explain/recording/units.h"

namespace cavum::explain {

/// What a recording's reader is told beside the file.
struct ReadingOptions {
  std::map<std::string, std::string>
      names;  ///< contract name or t, x, v, f → name in the file, with or without its unit
  std::map<std::string, std::string>
      units;  ///< the same, or a name in the file → unit; goes before that of the file
  std::vector<std::string>
      negate;  ///< x, v or f, or their contract names: the file counts the other way
  std::optional<double>
      surface_mm;  ///< where the surface is in the file's positions, mm, before any change of sign
  std::optional<double> lever_mm;  ///< of angles and torques, > 0
  bool with_position = true;       ///< false: a force over time, which needs no position
};

/// How one of the four columns is read.
struct ColumnReading {
  Role role = Role::time;
  std::size_t at = 0;  ///< in the header, from 0
  HeaderName header;
  Unit unit;               ///< as it applies, at the lever
  bool declared = false;   ///< the file or an option says the unit; else ours is taken
  bool by_option = false;  ///< named by --column
  bool negated = false;
};

struct ColumnPlan {
  std::vector<ColumnReading> motion;  ///< time first; position and speed may be absent
  std::optional<std::size_t> session,
      date;                        ///< columns that name the run, and the day of a time of day
  std::vector<std::string> names;  ///< of all columns, as the recording keeps them
  [[nodiscard]] const ColumnReading* of(Role role) const;
};

/// Throws Error(at, ...) when a column is missing (with all names, and the nearest), when several
/// could be one, when a unit is unknown, when an angle has no lever, or when an option names
/// nothing.
[[nodiscard]] ColumnPlan plan_columns(const std::vector<HeaderName>& header,
                                      const ReadingOptions& options, const std::string& at);

}  // namespace cavum::explain
