#include "engine/lab/explain/recording/date_time.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "engine/base/csv.h"
#include "engine/base/text.h"

namespace cavum::explain {
namespace {

constexpr double k_day_s = 86400.0;
constexpr double k_year_2000_s = 946684800.0, k_year_2100_s = 4102444800.0;  // since 1970
constexpr std::size_t k_longest_stamp = 60;

/// Takes pieces off the front of a stamp.
class Pieces {
 public:
  explicit Pieces(std::string_view text) : left_(text) {}
  std::optional<std::int64_t> whole(std::size_t least, std::size_t most) {
    std::size_t n = 0;
    while (n < left_.size() && n < most && left_[n] >= '0' && left_[n] <= '9') ++n;
    if (n < least) return std::nullopt;
    std::int64_t value = 0;
    std::from_chars(left_.data(), left_.data() + n, value);
    left_.remove_prefix(n);
    return value;
  }
  bool take(char c) {
    if (!left_.starts_with(c)) return false;
    left_.remove_prefix(1);
    return true;
  }
  bool take_word(std::string_view word) {
    if (left_.size() < word.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i)
      if ((left_[i] | 0x20) != word[i]) return false;
    left_.remove_prefix(word.size());
    return true;
  }
  void blanks() { left_ = left_.substr(std::min(left_.find_first_not_of(' '), left_.size())); }
  /// ".123" or ",123", else 0.
  double fraction() {
    if (left_.size() < 2 || (left_[0] != '.' && left_[0] != ',') || left_[1] < '0' ||
        left_[1] > '9')
      return 0.0;
    left_.remove_prefix(1);
    double value = 0.0, place = 0.1;
    for (; !left_.empty() && left_[0] >= '0' && left_[0] <= '9';
         left_.remove_prefix(1), place /= 10.0)
      value += place * (left_[0] - '0');
    return value;
  }
  [[nodiscard]] bool empty() const { return left_.empty(); }
  [[nodiscard]] std::string_view left() const { return left_; }

 private:
  std::string_view left_;
};

bool is_leap(std::int64_t year) { return (year % 4 == 0 && year % 100 != 0) || year % 400 == 0; }

/// Days since 1970-01-01 in the proleptic Gregorian calendar (Howard Hinnant, days_from_civil);
/// none for what is no date.
std::optional<std::int64_t> days(std::int64_t year, std::int64_t month, std::int64_t day) {
  if (year < 1900 || year > 2200 || month < 1 || month > 12 || day < 1) return std::nullopt;
  constexpr std::array<std::int64_t, 12> k_length{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  if (day > k_length[static_cast<std::size_t>(month - 1)] + (month == 2 && is_leap(year) ? 1 : 0))
    return std::nullopt;
  const std::int64_t y = month <= 2 ? year - 1 : year, era = y / 400, of_era = y - era * 400;
  const std::int64_t of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
}

/// Takes a date: ISO, with points, with slashes. None: there is none at the front.
std::optional<std::int64_t> take_date(Pieces& in, SlashOrder order) {
  const auto first = in.whole(1, 4);
  if (!first) return std::nullopt;
  const char between = in.left().empty() ? ' ' : in.left().front();
  if ((between != '-' && between != '.' && between != '/') || !in.take(between))
    return std::nullopt;
  const auto second = in.whole(1, 2);
  if (!second || !in.take(between)) return std::nullopt;
  const auto third = in.whole(1, 4);
  if (!third) return std::nullopt;
  if (*first > 31) return days(*first, *second, *third);  // the year first, whatever is between
  if (between == '-' || *third < 100) return std::nullopt;
  if (between == '.') return days(*third, *second, *first);
  if (order == SlashOrder::unknown) return std::nullopt;
  return order == SlashOrder::month_first ? days(*third, *first, *second)
                                          : days(*third, *second, *first);
}

/// Takes a time of day: HH:MM, HH:MM:SS.fff, AM or PM.
std::optional<double> take_time(Pieces& in) {
  auto hours = in.whole(1, 2);
  if (!hours || !in.take(':')) return std::nullopt;
  const auto minutes = in.whole(2, 2);
  if (!minutes || *minutes > 59) return std::nullopt;
  double seconds = 0.0;
  if (in.take(':')) {
    const auto whole = in.whole(2, 2);
    if (!whole || *whole > 60) return std::nullopt;
    seconds = static_cast<double>(*whole) + in.fraction();
  }
  Pieces after = in;
  after.blanks();
  const bool am = after.take_word("am"), pm = !am && after.take_word("pm");
  if (am || pm) {
    if (*hours < 1 || *hours > 12) return std::nullopt;
    hours = *hours % 12 + (pm ? 12 : 0);
    in = after;
  }
  if (*hours > 23) return std::nullopt;
  return static_cast<double>(*hours * 3600 + *minutes * 60) + seconds;
}

/// Takes Z, or the hours that the clock is ahead of it: seconds; 0 where nothing stands. None:
/// something else does.
std::optional<double> take_zone(Pieces& in) {
  in.blanks();
  if (in.take('Z') || in.take_word("utc") || in.empty()) return 0.0;
  const bool behind = in.take('-');
  if (!behind && !in.take('+')) return std::nullopt;
  const auto hours = in.whole(2, 2);
  in.take(':');
  const auto minutes = in.empty() ? std::optional<std::int64_t>(0) : in.whole(2, 2);
  if (!hours || !minutes || *hours > 14 || *minutes > 59) return std::nullopt;
  const auto ahead = static_cast<double>(*hours * 3600 + *minutes * 60);
  return behind ? -ahead : ahead;
}

/// Seconds since 1970 in the unit whose years are ours (2000 to 2100): its name and seconds.
std::optional<std::pair<const char*, double>> epoch_unit(double value) {
  constexpr std::array<std::pair<const char*, double>, 4> k_units{
      {{"s", 1.0}, {"ms", 1e-3}, {"µs", 1e-6}, {"ns", 1e-9}}};
  for (const auto& unit : k_units)
    if (value * unit.second >= k_year_2000_s && value * unit.second < k_year_2100_s) return unit;
  return std::nullopt;
}

}  // namespace

std::optional<Stamp> parse_stamp(std::string_view text, SlashOrder order) {
  if (text.size() > k_longest_stamp) return std::nullopt;
  Pieces in(text);
  Stamp out;
  Pieces ahead = in;
  if (ahead.whole(1, 2) && ahead.take(':')) {  // the time of day alone
    const auto second = take_time(in);
    if (!second || !in.empty()) return std::nullopt;
    out.second = *second;
    return out;
  }
  const auto day = take_date(in, order);
  if (!day) return std::nullopt;
  out.day = *day;
  out.dated = true;
  in.take('T');
  in.take(',');
  in.blanks();
  if (in.empty()) return out;
  const auto second = take_time(in);
  if (!second) return std::nullopt;
  const auto zone = take_zone(in);
  if (!zone || !in.empty()) return std::nullopt;
  out.second = *second - *zone;
  return out;
}

std::optional<SlashOrder> slash_order(std::string_view text) {
  Pieces in(text);
  const auto first = in.whole(1, 2);
  if (!first || !in.take('/')) return std::nullopt;
  const auto second = in.whole(1, 2);
  if (!second || !in.take('/')) return std::nullopt;
  if (*first > 12 && *second <= 12) return SlashOrder::day_first;
  return *second > 12 && *first <= 12 ? SlashOrder::month_first : SlashOrder::unknown;
}

bool looks_like_stamp(std::string_view cell) {
  if (cell.size() < 4 || cell.size() > k_longest_stamp || cell.front() < '0' || cell.front() > '9')
    return false;
  if (cell.find_first_not_of("0123456789:.,-/+TZ APMUCapmuc") != std::string_view::npos)
    return false;
  const auto many = [&](char c) { return std::count(cell.begin(), cell.end(), c); };
  return many(':') > 0 || many('-') == 2 || many('/') == 2 || many('.') == 2;
}

void StampReader::begin(std::string_view cell) {
  begun_ = true;
  if (const auto number = number_in(cell, decimal_)) {
    const auto unit = epoch_unit(*number);
    if (!unit || (declared_ && *number * factor_ < k_year_2000_s))
      return;  // a machine that has run for weeks counts as high
    kind_ = Kind::epoch;
    epoch_unit_ = unit->first;
    factor_ = unit->second;
    zero_ = *number;
    return;
  }
  order_ = slash_order(cell).value_or(SlashOrder::unknown);
  const auto stamp = parse_stamp(cell, order_);
  if (!stamp) return;
  kind_ = stamp->dated ? Kind::date : Kind::clock;
  first_ = *stamp;
  last_second_ = stamp->second;
}

std::optional<double> StampReader::of_stamp(const Stamp& stamp) {
  if (stamp.dated != (kind_ == Kind::date)) return std::nullopt;
  if (!stamp.dated && stamp.second < last_second_ - 0.5 * k_day_s) ++midnights_;
  last_second_ = stamp.second;
  return static_cast<double>(stamp.day - first_.day + midnights_) * k_day_s +
         (stamp.second - first_.second);
}

std::optional<double> StampReader::seconds(std::string_view cell) {
  ambiguous_ = false;
  if (!begun_) begin(cell);
  if (kind_ == Kind::seconds || kind_ == Kind::epoch) {
    if (const auto number = number_in(cell, decimal_)) return (*number - zero_) * factor_;
    ambiguous_ = slash_order(cell) == SlashOrder::unknown;
    return std::nullopt;
  }
  const auto stamp = parse_stamp(cell, order_);
  return stamp ? of_stamp(*stamp) : std::nullopt;
}

Message StampReader::words() const {
  switch (kind_) {
    case Kind::date:
      return msg("date stamps, from the first row");
    case Kind::clock:
      return msg("times of day, from the first row");
    case Kind::epoch:
      return msg("Unix time in {}, from the first row", epoch_unit_);
    case Kind::seconds:
      break;
  }
  return msg("numbers × {}", as_s(factor_, k_as_needed));
}

}  // namespace cavum::explain
