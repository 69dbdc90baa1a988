// Fields of JSON that somebody else wrote: what is missing, or of another type than it should be, counts as not there, instead of an exception
// that speaks of no file.
#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>

#include "engine/base/error.h"
#include "engine/base/where.h"

namespace cavum {

/// The member `key` when `j` is an object that has it; else null.
[[nodiscard]] inline const nlohmann::json& member_of(const nlohmann::json& j, const char* key) {
  static const nlohmann::json k_none;
  if (!j.is_object()) return k_none;
  const auto found = j.find(key);
  return found == j.end() ? k_none : *found;
}
/// Text of a member; empty when it is none.
[[nodiscard]] inline std::string text_in(const nlohmann::json& j, const char* key) {
  const auto& m = member_of(j, key);
  return m.is_string() ? m.get<std::string>() : std::string();
}
/// A whole number of a member that is one: a fraction, or a number beyond its type's range, is refused instead of being cut to something else.
template <class Whole>
[[nodiscard]] Whole require_whole(const nlohmann::json& j, const char* key, const Where& where) {
  const auto& m = member_of(j, key);
  const bool beyond = m.is_number_unsigned() && m.get<std::uint64_t>() > INT64_MAX,
             negative = !m.is_number_unsigned() && m.is_number_integer() && m.get<std::int64_t>() < 0;
  const bool fits = m.is_number_integer() && !(std::is_unsigned_v<Whole> ? negative : beyond);
  if (!fits) throw Error(where, msg("'{}' is no whole number in its range", key), msg("use an intact copy"));
  return m.get<Whole>();
}
/// A whole number of a member; 0 when it is none.
[[nodiscard]] inline std::int64_t whole_in(const nlohmann::json& j, const char* key) {
  const auto& m = member_of(j, key);
  return m.is_number_integer() && !(m.is_number_unsigned() && m.get<std::uint64_t>() > INT64_MAX) ? m.get<std::int64_t>() : 0;
}

}  // namespace cavum
