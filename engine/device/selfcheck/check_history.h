// What a station keeps of its self-checks: a file of signed lines, only ever added to, each with
// the hash of the one before. One file for all styluses of the station; a check counts for the
// stylus whose serial number it has.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/device/selfcheck/check_entry.h"

namespace cavum {

/// Where the station keeps it: selfcheck.jsonl in its own folder ($CAVUM_HOME, else
/// ~/.config/cavum).
[[nodiscard]] std::string check_history_path();
/// The station's name as `set_station_name` keeps it (station.name in its own folder), or else
/// "station " and the first 8 digits of its key.
[[nodiscard]] std::string station_name(const SigningKey& key);
/// Throws Error for a name that is empty, too long or of several lines, and when it cannot be
/// written.
void set_station_name(const std::string& name);

class CheckHistory {
 public:
  /// Bytes of such a file.
  static constexpr std::size_t k_largest_history = 16U << 20;

  /// Reads it; a file that is not there is empty, and a last line that was cut short is left out.
  /// Throws Error where a line is damaged, is out of its place or not signed, or the file is too
  /// large.
  explicit CheckHistory(std::string path);

  [[nodiscard]] const std::vector<CheckEntry>& entries() const noexcept { return entries_; }
  /// Checks of this stylus since its last new history that count (learning and unchanged), oldest
  /// first.
  [[nodiscard]] std::vector<ArmFigures> earlier(const CheckedStylus& stylus) const;
  /// The last check of this stylus, and what was decided on it; each as the line has it.
  [[nodiscard]] std::optional<CheckEntry> last_check(const CheckedStylus& stylus) const;
  [[nodiscard]] std::optional<CheckEntry> last_decision(const CheckedStylus& stylus) const;
  /// For the session: {"check":…,"decision":…} of the last check, the second only where there is
  /// one; empty without a check.
  [[nodiscard]] std::string session_note(const CheckedStylus& stylus) const;

  /// Judges `figures` by the checks before, and adds them. Throws Error when it cannot be written,
  /// or another program added to it meanwhile.
  CheckVerdict add_check(const CheckedStylus& stylus, const ArmFigures& figures,
                         std::int64_t utc_ns, const SigningKey& key);
  void add_decision(const CheckedStylus& stylus, bool go_on, const std::string& by,
                    const std::string& reason, std::int64_t utc_ns, const SigningKey& key);
  /// Repaired, or another that shall count: what was learnt of this stylus is no longer compared
  /// with. `reason` must not be empty.
  void begin_again(const CheckedStylus& stylus, const std::string& reason, std::int64_t utc_ns,
                   const SigningKey& key);

 private:
  void add(CheckEntry entry, const SigningKey& key);

  std::string path_;
  std::vector<CheckEntry> entries_;
  std::vector<std::string> lines_;
  std::size_t sound_bytes_ = 0;  // of whole lines
};

}  // namespace cavum
