// Structs that travel as JSON. A struct says once which of its members do; from that come reading within limits, writing, and the description of the
// type for the pages. A refusal names the field.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/base/error.h"

// MACRO ITEM for each item, in their order.
#define CAVUM_AGAIN ()
#define CAVUM_EXPAND(...) CAVUM_EXPAND3(CAVUM_EXPAND3(CAVUM_EXPAND3(CAVUM_EXPAND3(__VA_ARGS__))))
#define CAVUM_EXPAND3(...) CAVUM_EXPAND2(CAVUM_EXPAND2(CAVUM_EXPAND2(CAVUM_EXPAND2(__VA_ARGS__))))
#define CAVUM_EXPAND2(...) CAVUM_EXPAND1(CAVUM_EXPAND1(CAVUM_EXPAND1(__VA_ARGS__)))
#define CAVUM_EXPAND1(...) __VA_ARGS__
#define CAVUM_EACH(MACRO, ...) CAVUM_EXPAND(CAVUM_EACH_NEXT(MACRO, __VA_ARGS__))
#define CAVUM_EACH_NEXT(MACRO, ITEM, ...) MACRO ITEM __VA_OPT__(CAVUM_EACH_NEXT_NAME CAVUM_AGAIN(MACRO, __VA_ARGS__))
#define CAVUM_EACH_NEXT_NAME() CAVUM_EACH_NEXT
#define CAVUM_MEMBER(TYPE, NAME, ...) TYPE NAME = {};
#define CAVUM_TELL(TYPE, NAME, ...) what(#NAME, self.NAME, __VA_OPT__(true ||) k_is_optional<TYPE>);
#define CAVUM_LIMITED(TYPE, NAME, ...) &&is_limited<TYPE>()
/// Members of a struct, each (type, name) or (type, name, optional). One that is optional may be missing, or null, and then keeps its value. So may a
/// std::optional, which is left out where it is empty.
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

/// A text or list of so many bytes or elements.
template <class T, std::size_t most>
struct AtMost : T {
  AtMost() = default;
  template <std::convertible_to<T> From>
  AtMost(From&& from) : T(std::forward<From>(from)) {}  // NOLINT(bugprone-forwarding-reference-overload): of its own kind it is the same
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

/// `T` says its fields. Those of a `Base` that it names are its own, too.
template <class T>
concept JsonStruct = requires {
  T::k_limited;
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
  if constexpr (JsonStruct<T>) {
    if constexpr (requires { typename T::Base; }) return T::k_limited && is_limited<typename T::Base>();
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
    return std::is_arithmetic_v<T> || std::is_enum_v<T> || std::same_as<T, nlohmann::json> || requires { T::k_least; };
  }
}

template <FieldName name, class T>
struct Only {
  T value = {};
  static constexpr bool k_limited = is_limited<T>();
  template <class Self, class What>
  static void each_own_field(Self& self, const What& what) {
    what(name.text, self.value, false);
  }
};

/// what(name, member, may be missing) of each field.
template <class T, class What>
void each_field(T& of, const What& what) {
  using Plain = std::remove_const_t<T>;
  if constexpr (requires { typename Plain::Base; })
    each_field(static_cast<std::conditional_t<std::is_const_v<T>, const typename Plain::Base, typename Plain::Base>&>(of), what);
  Plain::each_own_field(of, what);
}

template <class T>
[[nodiscard]] nlohmann::json to_json_value(const T& value) {
  if constexpr (JsonStruct<T>) {
    nlohmann::json out = nlohmann::json::object();
    each_field(value, [&](const std::string& name, const auto& member, bool) {
      if constexpr (k_is_optional<std::remove_cvref_t<decltype(member)>>) {
        if (member) out[name] = to_json_value(*member);
      } else {
        out[name] = to_json_value(member);
      }
    });
    return out;
  } else if constexpr (NamedEnum<T>) {
    return names_of(value)[static_cast<std::size_t>(value)];
  } else if constexpr (JsonMap<T>) {
    nlohmann::json out = nlohmann::json::object();
    for (const auto& [name, one] : value) out[name] = to_json_value(one);
    return out;
  } else if constexpr (JsonList<T>) {
    nlohmann::json out = nlohmann::json::array();
    for (const auto& one : value) out.push_back(to_json_value(one));
    return out;
  } else if constexpr (std::derived_from<T, std::string>) {
    return static_cast<const std::string&>(value);
  } else if constexpr (requires { T::k_least; }) {
    return value.value;
  } else if constexpr (std::is_empty_v<T>) {
    return nlohmann::json::object();
  } else {
    return value;
  }
}

/// `field` is its name as a refusal says it: "sitting.exam". Throws Error when `from` is none, or beyond a limit.
template <class T>
void read_json_value(const nlohmann::json& from, const std::string& field, T& into) {
  const auto require = [&field](bool good, const Message& is) {
    if (!good) throw Error(Name{fmt::format("'{}'", field)}, is, msg("send it as docs/office.md says"));
  };
  if constexpr (JsonStruct<T>) {
    require(from.is_object(), msg("is no object"));
    each_field(into, [&](const std::string& name, auto& member, bool optional) {
      const auto found = from.find(name);
      const std::string whole = field.empty() ? name : field + "." + name;
      if (found != from.end() && !found->is_null()) return read_json_value(*found, whole, member);
      if (!optional) throw Error(fmt::format("'{}'", whole), msg("is missing"), msg("send it as docs/office.md says"));
    });
  } else if constexpr (k_is_optional<T>) {
    read_json_value(from, field, into.emplace());
  } else if constexpr (NamedEnum<T>) {
    const auto names = names_of(into);
    const auto found = std::find(names.begin(), names.end(), from.is_string() ? from.template get<std::string>() : "");
    require(found != names.end(), msg("is none of: {}", list_of(names)));
    into = static_cast<T>(found - names.begin());
  } else if constexpr (JsonMap<T>) {
    require(from.is_object(), msg("is no object"));
    for (const auto& [name, one] : from.items()) read_json_value(one, field + "." + name, into[name]);
  } else if constexpr (JsonList<T>) {
    require(from.is_array(), msg("is no list"));
    if constexpr (requires { T::k_most; }) require(from.size() <= T::k_most, msg("has more than {} elements", T::k_most));
    for (const auto& one : from) {
      const std::string place = fmt::format("{}[{}]", field, into.size());
      read_json_value(one, place, into.emplace_back());
    }
  } else if constexpr (std::derived_from<T, std::string>) {
    require(from.is_string(), msg("is no text"));
    static_cast<std::string&>(into) = from.template get<std::string>();
    if constexpr (requires { T::k_most; }) require(into.size() <= T::k_most, msg("is longer than {} bytes", T::k_most));
    if constexpr (requires { into.problem(); }) require(into.problem().empty(), into.problem());
  } else if constexpr (std::same_as<T, bool>) {
    require(from.is_boolean(), msg("is neither true nor false"));
    into = from;
  } else if constexpr (std::integral<T>) {
    const bool fits = from.is_number_unsigned() ? std::in_range<T>(from.template get<std::uint64_t>())
                                                : from.is_number_integer() && std::in_range<T>(from.template get<std::int64_t>());
    require(fits, msg("is no whole number in its range"));
    into = from;
  } else if constexpr (requires { T::k_least; }) {
    read_json_value(from, field, into.value);
    require(into.value >= T::k_least && into.value <= T::k_most, msg("is not between {} and {}", T::k_least, T::k_most));
  } else if constexpr (std::floating_point<T>) {
    require(from.is_number(), msg("is no number"));
    into = from;
  } else {
    static_assert(std::same_as<T, nlohmann::json>);
    into = from;
  }
}

}  // namespace cavum
