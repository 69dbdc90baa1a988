// What Cavum has to say to a person, before it is put into words: a sentence with gaps, as it
// stands in the source in English, and the typed values that belong into the gaps. Rooms make
// messages; a face (command line, window, office, report) renders them in the reader's language,
// with its number format and plural forms. Nothing is decided by a rendered text, and nothing is
// read back from one.
#pragma once

#include <fmt/core.h>

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "engine/base/vec.h"

namespace cavum {

enum class Unit : std::uint8_t {
  none,
  mm,
  mm2,
  mm3,
  um,
  newton,
  deg,
  second,
  minute,
  ms,
  rpm,
  percent,
  hz,
  mm_per_s,
  n_per_mm,
  byte
};
/// "mm³", "N", "%"; empty for none.
[[nodiscard]] std::string_view unit_sign(Unit unit) noexcept;
/// "mm3", "N", "%", as JSON and files have it; empty for none.
[[nodiscard]] std::string_view unit_id(Unit unit) noexcept;
/// None where it is no unit of ours.
[[nodiscard]] std::optional<Unit> unit_of(std::string_view id) noexcept;

/// A figure: rendered with `digits` after the point (k_as_needed: up to six significant ones), its
/// bound behind ± where it has one, and its unit.
struct Number {
  double value = 0.0;
  Unit unit = Unit::none;
  int digits = 2;
  double bound = 0.0;
  bool sign = false;  ///< "+0.3"
  friend bool operator==(const Number&, const Number&) = default;
};
inline constexpr int k_as_needed = -1;

[[nodiscard]] constexpr Number as_number(double v, int digits = k_as_needed) noexcept {
  return {v, Unit::none, digits};
}
[[nodiscard]] constexpr Number as_mm(double v, int digits = 2, double bound = 0) noexcept {
  return {v, Unit::mm, digits, bound};
}
[[nodiscard]] constexpr Number as_mm2(double v, int digits = 2, double bound = 0) noexcept {
  return {v, Unit::mm2, digits, bound};
}
[[nodiscard]] constexpr Number as_mm3(double v, int digits = 2, double bound = 0) noexcept {
  return {v, Unit::mm3, digits, bound};
}
[[nodiscard]] constexpr Number as_n(double v, int digits = 2, double bound = 0) noexcept {
  return {v, Unit::newton, digits, bound};
}
[[nodiscard]] constexpr Number as_deg(double v, int digits = 0, double bound = 0) noexcept {
  return {v, Unit::deg, digits, bound};
}
[[nodiscard]] constexpr Number as_s(double v, int digits = 2, double bound = 0) noexcept {
  return {v, Unit::second, digits, bound};
}
[[nodiscard]] constexpr Number as_percent(double v, int digits = 0, double bound = 0) noexcept {
  return {v, Unit::percent, digits, bound};
}
/// Points of a mark, which a sentence names itself: "{} of {} points".
[[nodiscard]] constexpr Number as_points(double v, int digits = 1) noexcept {
  return {v, Unit::none, digits};
}
[[nodiscard]] constexpr Number as_unit(double v, Unit unit, int digits = k_as_needed) noexcept {
  return {v, unit, digits};
}

/// A time of an exam as a clock shows it: "1:05".
struct ClockTime {
  double seconds = 0.0;
  friend bool operator==(const ClockTime&, const ClockTime&) = default;
};
/// A name, path, identifier or anything else that a person or a file wrote: in every language as it
/// is.
struct Name {
  std::string text;
  friend bool operator==(const Name&, const Name&) = default;
};
/// A word of the field that data name (a tissue, a wall): in the reader's language where the
/// catalogue has it, else as it is.
struct Term {
  std::string english;
  friend bool operator==(const Term&, const Term&) = default;
};
/// A sentence of a scenario's author: in the reader's language where its file has it in that
/// language, else as it is.
struct Authored {
  std::string english;
  friend bool operator==(const Authored&, const Authored&) = default;
};

/// A place in a file, "file:line:column"; line and column from 1, 0 = of which nothing is known.
struct FileLocation {
  std::string file;
  int line = 0, column = 0;
  friend bool operator==(const FileLocation&, const FileLocation&) = default;
};

struct Value;

/// A sentence with its values; or nothing at all.
class Message {
 public:
  Message() = default;
  /// A text that is no sentence of ours: a name, a path.
  Message(Name name);           // NOLINT(google-explicit-constructor)
  Message(FileLocation place);  // NOLINT(google-explicit-constructor)
  Message(const char* english, const char* plural, std::int64_t count, std::vector<Value> values);

  [[nodiscard]] bool empty() const noexcept { return english_ == nullptr; }
  /// The sentence in English, with gaps as fmt writes them: what the catalogue is asked for. Not
  /// for an empty one.
  [[nodiscard]] const char* english() const noexcept { return english_; }
  /// The English plural form, null where the message has one form only; and what it counts.
  [[nodiscard]] const char* plural() const noexcept { return plural_; }
  [[nodiscard]] std::int64_t count() const noexcept { return count_; }
  [[nodiscard]] const std::vector<Value>& values() const noexcept { return values_; }
  friend bool operator==(const Message& a, const Message& b);

 private:
  const char* english_ = nullptr;
  const char* plural_ = nullptr;
  std::int64_t count_ = 0;
  std::vector<Value> values_;
};

/// Messages one after another with ", " between them ("; " for sentences).
struct List {
  std::vector<Message> items;
  bool sentences = false;
  friend bool operator==(const List&, const List&) = default;
};

struct Value : std::variant<std::int64_t, Number, ClockTime, Vec3, Name, FileLocation, Term,
                            Authored, List, Message> {
  using variant::variant;
};

/// Names with ", " between them.
template <class Names>
[[nodiscard]] List list_of(const Names& names) {
  List list;
  for (const auto& n : names) list.items.emplace_back(Name{std::string(n)});
  return list;
}

namespace message_detail {

template <class A>
Value value_of(A&& a) {
  using T = std::remove_cvref_t<A>;
  static_assert(!std::is_same_v<T, bool> && !std::is_same_v<T, char>, "give a word or a number");
  if constexpr (std::is_floating_point_v<T>)
    return Value(as_number(static_cast<double>(a)));
  else if constexpr (std::integral<T>)
    return Value(static_cast<std::int64_t>(a));
  else if constexpr (std::is_convertible_v<A, std::string_view>)
    return Value(Name{std::string(std::string_view(a))});
  else
    return Value(std::forward<A>(a));
}

/// Every value is shown as a text: the compiler holds the gaps against as many texts.
template <class>
using Text = std::string_view;

}  // namespace message_detail

/// `english` with its values: texts are names, numbers have their units (as_mm) or none. xgettext
/// finds the sentence here.
template <class... A>
[[nodiscard]] Message msg(fmt::format_string<message_detail::Text<A>...> english, A&&... values) {
  return {fmt::string_view(english).data(),
          nullptr,
          0,
          {message_detail::value_of(std::forward<A>(values))...}};
}
/// The same in the form that `count` takes: `one` where that is 1 in English, else `many`. Both
/// have the same gaps.
template <class... A>
[[nodiscard]] Message msgn(fmt::format_string<message_detail::Text<A>...> one,
                           fmt::format_string<message_detail::Text<A>...> many, std::int64_t count,
                           A&&... values) {
  return {fmt::string_view(one).data(),
          fmt::string_view(many).data(),
          count,
          {message_detail::value_of(std::forward<A>(values))...}};
}

/// How a language writes. Two there are: English, which needs no catalogue, and one of a catalogue
/// (ui/language).
class Locale {
 public:
  Locale() = default;
  Locale(const Locale&) = delete;
  Locale& operator=(const Locale&) = delete;
  virtual ~Locale() = default;
  /// A sentence, or the form of it that `count` takes.
  [[nodiscard]] virtual std::string sentence(const char* english) const = 0;
  [[nodiscard]] virtual std::string sentence(const char* one, const char* many,
                                             std::int64_t count) const = 0;
  [[nodiscard]] virtual std::string term(const std::string& english) const = 0;
  [[nodiscard]] virtual std::string authored(const std::string& english) const = 0;
  [[nodiscard]] virtual std::string name(const std::string& text) const = 0;
  /// Between whole and decimal digits.
  [[nodiscard]] virtual char decimal_sign() const noexcept = 0;
};

[[nodiscard]] std::string render(const Message& message, const Locale& locale);
[[nodiscard]] std::string render(const Value& value, const Locale& locale);
/// In English: for logs, tests, and what()'s of exceptions.
[[nodiscard]] std::string english_text(const Message& message);
/// In JSON for other programs: its English text (nlohmann::json asks for this).
template <class Json>
void to_json(Json& json, const Message& message) {
  json = english_text(message);
}

}  // namespace cavum
