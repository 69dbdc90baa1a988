// One line of what a station keeps of its self-checks: a check, what was decided on it, or the
// beginning of a new history. JSON, signed by the station; the last check goes into each session as
// it stands (note `self_check`).
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/base/where.h"
#include "engine/device/selfcheck/check_rule.h"
#include "engine/session/station_key.h"

namespace cavum {

/// Which stylus was checked.
struct CheckedStylus {
  std::string id, serial;
  friend bool operator==(const CheckedStylus&, const CheckedStylus&) = default;
};

struct CheckEntry {
  enum class Kind { check, decision, new_history };
  Kind kind = Kind::check;
  std::int64_t utc_ns = 0;
  std::string station;      ///< its name
  std::string station_key;  ///< hexadecimal; signs the entry
  CheckedStylus stylus;
  ArmFigures figures;    ///< of a check
  CheckVerdict verdict;  ///< of a check
  std::int64_t since_utc_ns =
      0;  ///< of a check that found a change: of the first of those without a good one between them
  bool go_on = false;    ///< of a decision: the exam takes place with it
  std::string by;        ///< of a decision: `supervisor` (by the code) or `person`
  std::string reason;    ///< of a decision or a new history; may be empty
  std::string previous;  ///< SHA-256 of the line before, hexadecimal; of the first line empty
};

/// The name of the value of `kind`.
[[nodiscard]] const char* kind_name(CheckEntry::Kind kind) noexcept;
/// With its signature.
[[nodiscard]] nlohmann::json to_signed_json(const CheckEntry& entry, const SigningKey& key);
/// Throws Error at `where` when it is no entry, or its signature is not that of its `station_key`.
[[nodiscard]] CheckEntry read_check_entry(const nlohmann::json& j, const Where& where);

/// Largest length of a station's name and of a reason, bytes.
inline constexpr std::size_t k_longest_station_name = 60, k_longest_check_reason = 300;

}  // namespace cavum
