// Structs as JSON. A struct says once which of its members it has there; from that come writing,
// reading within limits, and the description of the type for the pages. A refusal names the field.
// CAVUM_JSON declares the members and names them; a struct that is declared elsewhere has a
// template json_fields in its namespace, which CAVUM_JSON_OF(Seat, (station), (ticket)) writes.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/message_json.h"
#include "engine/base/text.h"
#include "engine/base/vec.h"
#include "engine/base/where.h"

// MACRO ITEM for each item, in their order.
#define CAVUM_AGAIN ()
#define CAVUM_EXPAND(...) CAVUM_EXPAND3(CAVUM_EXPAND3(CAVUM_EXPAND3(CAVUM_EXPAND3(__VA_ARGS__))))
#define CAVUM_EXPAND3(...) CAVUM_EXPAND2(CAVUM_EXPAND2(CAVUM_EXPAND2(CAVUM_EXPAND2(__VA_ARGS__))))
#define CAVUM_EXPAND2(...) CAVUM_EXPAND1(CAVUM_EXPAND1(CAVUM_EXPAND1(__VA_ARGS__)))
#define CAVUM_EXPAND1(...) __VA_ARGS__
#define CAVUM_EACH(MACRO, ...) CAVUM_EXPAND(CAVUM_EACH_NEXT(MACRO, __VA_ARGS__))
#define CAVUM_EACH_NEXT(MACRO, ITEM, ...) \
  MACRO ITEM __VA_OPT__(CAVUM_EACH_NEXT_NAME CAVUM_AGAIN(MACRO, __VA_ARGS__))
#define CAVUM_EACH_NEXT_NAME() CAVUM_EACH_NEXT
#define CAVUM_NAME(NAME, ...) of(#NAME, self.NAME __VA_OPT__(, JsonField::__VA_ARGS__));
/// In a json_fields(of, self): members by their own names, each (name), (name, optional) or (name,
/// sparse).
#define CAVUM_NAMES(...) CAVUM_EACH(CAVUM_NAME, __VA_ARGS__)
#define CAVUM_JSON_OF(TYPE, ...) \
  void json_fields(auto& of, JsonOf<TYPE> auto& self) { CAVUM_NAMES(__VA_ARGS__) }
#define CAVUM_MEMBER(TYPE, NAME, ...) TYPE NAME = {};
#define CAVUM_TELL(TYPE, NAME, ...) what(#NAME, self.NAME __VA_OPT__(, JsonField::__VA_ARGS__));
#define CAVUM_LIMITED(TYPE, NAME, ...) &&is_limited<TYPE>()
/// Members of a struct, each (type, name) or (type, name, optional). One that is optional may be
/// missing, or null, and then keeps its value. So may a std::optional, which is left out where it
/// is empty.
#define CAVUM_FIELDS(...)                                    \
  CAVUM_EACH(CAVUM_MEMBER, __VA_ARGS__)                      \
  template <class Self, class What>                          \
  static void each_own_field(Self& self, const What& what) { \
    CAVUM_EACH(CAVUM_TELL, __VA_ARGS__)                      \
  }                                                          \
  static constexpr bool k_limited = true CAVUM_EACH(CAVUM_LIMITED, __VA_ARGS__);
#define CAVUM_JSON(NAME, ...) \
  struct NAME {               \
    CAVUM_FIELDS(__VA_ARGS__) \
  };
/// With the fields of another one before its own.
#define CAVUM_JSON_MORE(NAME, OTHER, ...) \
  struct NAME : OTHER {                   \
    using Base = OTHER;                   \
    CAVUM_FIELDS(__VA_ARGS__)             \
  };

namespace cavum {

/// A field is always there; or may be missing, and then keeps its value; or is left out where it is
/// empty, as an empty std::optional always is.
enum class JsonField { always, optional, sparse };

/// A text or list of so many bytes or elements.
template <class T, std::size_t most>
struct AtMost : T {
  AtMost() = default;
  template <std::convertible_to<T> From>
  AtMost(From&& from)
      : T(std::forward<From>(from)) {
  }  // NOLINT(bugprone-forwarding-reference-overload): of its own kind it is the same
  static constexpr std::size_t k_most = most;
};
template <std::size_t most_bytes>
using Text = AtMost<std::string, most_bytes>;
/// A whole number in these bounds.
template <std::int64_t least, std::int64_t most>
struct Between {
  std::int64_t value = least;
  Between(std::int64_t of = least) : value(of) {}
  operator std::int64_t() const { return value; }
  static constexpr std::int64_t k_least = least, k_most = most;
};

/// {"name": value}: a body with one field.
template <std::size_t size>
struct FieldName {
  char text[size] = {};
  consteval FieldName(const char (&name)[size]) { std::copy_n(name, size, text); }
};
template <FieldName name, class T>
struct Only;

/// The struct `T`, constant or not, for its json_fields.
template <class E, class T>
concept JsonOf = std::derived_from<std::remove_const_t<E>, T>;
/// An object that is no struct of its own: its fields are those that `fields(of)` names.
template <class Fields>
struct JsonInside {
  Fields fields;
};
template <class Fields>
[[nodiscard]] JsonInside<Fields> json_inside(Fields fields) {
  return {std::move(fields)};
}
template <class Of, class Fields>
void json_fields(Of& of, const JsonInside<Fields>& inside) {
  inside.fields(of);
}
/// A field that always has this text, by which a file says what it is.
struct JsonFormat {
  const char* text;
};

struct AnyJsonField {
  void operator()(const char*, auto&&, JsonField = JsonField::always) const {}
};
/// `T` says its fields by CAVUM_JSON. Those of a `Base` that it names are its own, too.
template <class T>
concept JsonDeclared = requires {
  T::k_limited;
};
template <class T>
concept JsonStruct = JsonDeclared<T> || requires(const AnyJsonField any, T of) {
  json_fields(any, of);
};
/// An enum whose names stand in `names_of(E)`, by value from 0 on.
template <class T>
concept NamedEnum = std::is_enum_v<T> && requires(T t) {
  names_of(t);
};

template <class T>
inline constexpr bool k_is_optional = false;
template <class T>
inline constexpr bool k_is_optional<std::optional<T>> = true;
/// An object of texts, in any order.
using JsonTexts = std::vector<std::pair<std::string, std::string>>;
template <class T>
concept JsonMap = requires {
  typename T::mapped_type;
}
&&!std::same_as<T, nlohmann::json>;
template <class T>
concept JsonList = requires(T t) {
  typename T::value_type;
  t.push_back(typename T::value_type());
}
&&!std::derived_from<T, std::string> && !std::same_as<T, nlohmann::json>;

/// Whether all that is read into a `T` has a limit of its own; a JSON value has that of parse_json.
template <class T>
[[nodiscard]] consteval bool is_limited() {
  if constexpr (JsonDeclared<T>) {
    if constexpr (requires { typename T::Base; })
      return T::k_limited && is_limited<typename T::Base>();
    return T::k_limited;
  } else if constexpr (k_is_optional<T>) {
    return is_limited<typename T::value_type>();
  } else if constexpr (JsonMap<T>) {
    return is_limited<typename T::mapped_type>();
  } else if constexpr (JsonList<T>) {
    return requires { T::k_most; }
    ? is_limited<typename T::value_type>() : false;
  } else if constexpr (std::derived_from<T, std::string>) {
    return requires { T::k_most; };
  } else {
    return std::is_arithmetic_v<T> || std::is_enum_v<T> || std::same_as<T, nlohmann::json> ||
           requires {
      T::k_least;
    };
  }
}

template <FieldName name, class T>
struct Only {
  T value = {};
  static constexpr bool k_limited = is_limited<T>();
  template <class Self, class What>
  static void each_own_field(Self& self, const What& what) {
    what(name.text, self.value);
  }
};

/// what(name, member, JsonField) of each field; without the last: it is always there.
template <class T, class What>
void each_field(T& of, const What& what) {
  using Plain = std::remove_const_t<T>;
  if constexpr (requires { typename Plain::Base; })
    each_field(static_cast<std::conditional_t<std::is_const_v<T>, const typename Plain::Base,
                                              typename Plain::Base>&>(of),
               what);
  if constexpr (JsonDeclared<Plain>)
    Plain::each_own_field(of, what);
  else
    json_fields(what, of);
}

/// Whether a field that is left out where it is empty is.
template <class T>
[[nodiscard]] bool is_left_out(const T& value, JsonField field) {
  if constexpr (k_is_optional<T>)
    return !value;
  else if constexpr (requires { value.empty(); })
    return field == JsonField::sparse && value.empty();
  else if constexpr (std::equality_comparable<T>)
    return field == JsonField::sparse && value == T();
  else
    return false;
}

/// A type that is none of those below has write_json(value) and read_json(json, place, into) beside
/// it.
template <class T>
[[nodiscard]] nlohmann::json to_json_value(const T& value) {
  using nlohmann::json;
  if constexpr (requires { write_json(value); }) {
    return write_json(value);
  } else if constexpr (JsonStruct<const T>) {
    json out = json::object();
    each_field(value, [&]<class Member>(const char* name, const Member& member,
                                        JsonField field = JsonField::always) {
      if (!is_left_out(member, field)) out[name] = to_json_value(member);
    });
    return out;
  } else if constexpr (k_is_optional<T>) {
    return to_json_value(*value);
  } else if constexpr (NamedEnum<T>) {
    return names_of(value)[static_cast<std::size_t>(value)];
  } else if constexpr (std::same_as<T, JsonFormat>) {
    return value.text;
  } else if constexpr (std::same_as<T, Vec3>) {
    return {value.x, value.y, value.z};
  } else if constexpr (std::same_as<T, Message> || std::same_as<T, std::vector<Message>>) {
    return encode(value);
  } else if constexpr (JsonMap<T> || std::same_as<T, JsonTexts>) {
    json out = json::object();
    for (const auto& [name, one] : value) out[name] = to_json_value(one);
    return out;
  } else if constexpr (JsonList<T>) {
    json out = json::array();
    for (const auto& one : value) out.push_back(to_json_value(one));
    return out;
  } else if constexpr (std::derived_from<T, std::string>) {
    return static_cast<const std::string&>(value);
  } else if constexpr (requires { T::k_least; }) {
    return value.value;
  } else if constexpr (std::is_empty_v<T>) {
    return json::object();
  } else {
    return value;
  }
}

/// Where JSON comes from, and how strictly it is read.
struct JsonSource {
  Where where;  ///< begins what a refusal says; may be empty
  Message advice;
  bool strict = true;  ///< what has no field, and null for a field, is refused
  std::size_t most_bytes = SIZE_MAX,
              most_elements = SIZE_MAX;  ///< of a text or list that has no limit of its own
  double largest = std::numeric_limits<double>::infinity();  ///< of numbers
};
/// A field of it, as a refusal says it: "sitting.exam"; empty: all of it.
struct JsonLocation {
  const JsonSource& source;
  std::string field = {};
  [[nodiscard]] JsonLocation member(std::string_view name) const {
    return {source, fmt::format("{}{}{}", field, field.empty() ? "" : ".", name)};
  }
  [[nodiscard]] Message text() const {
    if (field.empty()) return source.where;
    const std::string short_field = one_line(field.substr(0, 200));
    return source.where.empty() ? msg("'{}'", short_field)
                                : msg("{}: '{}'", source.where, short_field);
  }
  [[noreturn]] void refuse(const Message& is, FileError code = FileError::wrong_type) const {
    throw Error(code, text(), is, source.advice);
  }
  void require(bool good, const Message& is, FileError code = FileError::wrong_type) const {
    if (!good) refuse(is, code);
  }
};

template <class T>
void read_fields(const nlohmann::json& from, const JsonLocation& at, T& into) {
  at.require(from.is_object(), msg("is no object"));
  std::set<std::string> known;
  each_field(into, [&]<class Member>(const char* name, Member&& member,
                                     JsonField field = JsonField::always) {
    known.insert(name);
    const auto found = from.find(name);
    if (found != from.end() && (at.source.strict || !found->is_null()))
      return read_json_value(*found, at.member(name), member);
    if (field == JsonField::always && !k_is_optional<std::remove_cvref_t<Member>>)
      at.member(name).refuse(msg("is missing"), FileError::missing);
  });
  if (at.source.strict)
    for (const auto& [name, value] : from.items())
      if (!known.contains(name))
        at.member(name).refuse(msg("has no place here"), FileError::unknown);
}

/// Or a yes or no.
template <class T>
void read_number(const nlohmann::json& from, const JsonLocation& at, T& into) {
  if constexpr (std::same_as<T, bool>) {
    at.require(from.is_boolean(), msg("is neither true nor false"));
  } else if constexpr (std::integral<T>) {
    const bool fits = from.is_number_unsigned()
                          ? std::in_range<T>(from.template get<std::uint64_t>())
                          : from.is_number_integer() &&
                                sizeof(T) == sizeof(std::int64_t) &&  // smaller ones are counts
                                std::in_range<T>(from.template get<std::int64_t>());
    at.require(fits, msg("is no whole number in its range"), FileError::out_of_range);
  } else {
    at.require(from.is_number(), msg("is no number"));
  }
  into = from;
  if constexpr (std::floating_point<T>)
    at.require(std::fabs(into) <= at.source.largest,
               msg("is larger than {}", as_number(at.source.largest)), FileError::out_of_range);
}

/// Throws Error when `from` is none, or beyond a limit.
template <class T>
void read_json_value(const nlohmann::json& from, const JsonLocation& at, T& into) {
  if constexpr (requires { read_json(from, at, into); }) {
    read_json(from, at, into);
  } else if constexpr (JsonStruct<T>) {
    read_fields(from, at, into);
  } else if constexpr (k_is_optional<T>) {
    read_json_value(from, at, into.emplace());
  } else if constexpr (NamedEnum<T>) {
    const auto names = names_of(into);
    const auto found = std::find(names.begin(), names.end(),
                                 from.is_string() ? from.template get<std::string>() : "\n");
    at.require(found != names.end(), msg("is none of: {}", list_of(names)));
    into = static_cast<T>(found - names.begin());
  } else if constexpr (std::same_as<T, JsonFormat>) {
    at.require(from == into.text, msg("is not '{}'", into.text));
  } else if constexpr (std::same_as<T, Vec3>) {
    at.require(from.is_array() && from.size() == 3, msg("is no place: three numbers"));
    read_json_value(from[0], at, into.x), read_json_value(from[1], at, into.y),
        read_json_value(from[2], at, into.z);
  } else if constexpr (std::same_as<T, Message> || std::same_as<T, std::vector<Message>>) {
    try {
      if constexpr (std::same_as<T, Message>)
        into = decode_message(from);
      else
        into = decode_messages(from);
    } catch (const std::invalid_argument& e) {
      at.refuse(msg("is no message: {}", e.what()));
    }
  } else if constexpr (JsonMap<T> || std::same_as<T, JsonTexts>) {
    at.require(from.is_object(), msg("is no object"));
    for (const auto& [name, one] : from.items())
      if constexpr (JsonMap<T>)
        read_json_value(one, at.member(name), into[name]);
      else
        read_json_value(one, at.member(name), into.emplace_back(name, "").second);
  } else if constexpr (JsonList<T>) {
    std::size_t most = at.source.most_elements;
    if constexpr (requires { T::k_most; }) most = T::k_most;
    at.require(from.is_array(), msg("is no list"));
    at.require(from.size() <= most, msg("has more than {} elements", most), FileError::too_large);
    for (std::size_t i = 0; i < from.size(); ++i)
      read_json_value(from[i], {at.source, fmt::format("{}[{}]", at.field, i)},
                      into.emplace_back());
  } else if constexpr (requires { std::tuple_size<T>::value; }) {
    at.require(from.is_array() && from.size() == into.size(),
               msg("is no list of {} elements", into.size()));
    for (std::size_t i = 0; i < into.size(); ++i)
      read_json_value(from[i], {at.source, fmt::format("{}[{}]", at.field, i)}, into[i]);
  } else if constexpr (std::derived_from<T, std::string>) {
    at.require(from.is_string(), msg("is no text"));
    static_cast<std::string&>(into) = from.template get<std::string>();
    std::size_t most = at.source.most_bytes;
    if constexpr (requires { T::k_most; }) most = T::k_most;
    at.require(into.size() <= most, msg("is longer than {} bytes", most), FileError::too_large);
    if constexpr (requires { into.problem(); }) at.require(into.problem().empty(), into.problem());
  } else if constexpr (std::is_arithmetic_v<T>) {
    read_number(from, at, into);
  } else if constexpr (requires { T::k_least; }) {
    read_json_value(from, at, into.value);
    at.require(into.value >= T::k_least && into.value <= T::k_most,
               msg("is not between {} and {}", T::k_least, T::k_most), FileError::out_of_range);
  } else {
    static_assert(std::same_as<T, nlohmann::json>);
    into = from;
  }
}

/// The whole of it.
template <class T>
[[nodiscard]] T json_value_of(const nlohmann::json& from, const JsonSource& source) {
  T out{};
  read_json_value(from, JsonLocation{source}, out);
  return out;
}

}  // namespace cavum
