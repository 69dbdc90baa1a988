// Time stamps as machines write them: seconds, dates with a time of day, the time of day alone,
// seconds since 1970. All become seconds.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/message.h"
#include "engine/lab/explain/recording/number_form.h"

namespace cavum::explain {

/// A moment: whole days since 1970-01-01 and seconds of that day. `dated` false: only a time of
/// day, and `day` is 0.
struct Stamp {
  std::int64_t day = 0;
  double second = 0.0;
  bool dated = false;
};

/// Which date a stamp with slashes means.
enum class SlashOrder { unknown, month_first, day_first };

/// 2026-11-24T10:15:30.123 (a blank for T; Z or +01:00 behind), 24.11.2026 10:15:30,123, 11/24/2026
/// 10:15:30, 10:15:30.123 (AM, PM), a date alone. None when it is none of these, or no date of the
/// calendar. A date with slashes needs `order`.
[[nodiscard]] std::optional<Stamp> parse_stamp(std::string_view text,
                                               SlashOrder order = SlashOrder::unknown);
/// Order that a stamp with slashes shows: one of its numbers is beyond 12. Unknown otherwise; none
/// where there are no slashes.
[[nodiscard]] std::optional<SlashOrder> slash_order(std::string_view text);
/// Cheap: has the marks of a date or of a time of day, and no letters other than those of one.
[[nodiscard]] bool looks_like_stamp(std::string_view cell);

/// Turns the cells of a time column into seconds, row by row. What the first cell is, all must be.
class StampReader {
 public:
  enum class Kind { seconds, date, clock, epoch };
  /// `declared`: the column says its unit, so numbers are of that unit unless they are years away
  /// from it.
  StampReader(Decimal decimal, double factor, bool declared)
      : decimal_(decimal), factor_(factor), declared_(declared) {}

  /// Seconds; dates, times of day and seconds since 1970 from the first row, past midnight where
  /// only times of day are there. None when the cell is no stamp of the first row's kind.
  [[nodiscard]] std::optional<double> seconds(std::string_view cell);
  /// The last cell was none because it may be the 4th of November or the 11th of April.
  [[nodiscard]] bool ambiguous() const noexcept { return ambiguous_; }
  [[nodiscard]] Kind kind() const noexcept { return kind_; }
  /// In words: "s", "date stamps, from the first row", "Unix time in ms, from the first row".
  [[nodiscard]] Message words() const;

 private:
  void begin(std::string_view cell);
  std::optional<double> of_stamp(const Stamp& stamp);

  Decimal decimal_;
  double factor_;
  bool declared_, begun_ = false;
  Kind kind_ = Kind::seconds;
  SlashOrder order_ = SlashOrder::unknown;
  const char* epoch_unit_ = "s";
  double zero_ = 0.0;  // of seconds since 1970, in the file's unit
  Stamp first_;
  std::int64_t midnights_ = 0;
  double last_second_ = 0.0;
  bool ambiguous_ = false;
};

}  // namespace cavum::explain
