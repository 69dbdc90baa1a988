#include "engine/base/json_fields.h"

#include <nlohmann/json.hpp>
#include <type_traits>

#include "engine/base/error.h"

namespace cavum {

const nlohmann::json& member_of(const nlohmann::json& j, const char* key) {
  static const nlohmann::json k_none;
  if (!j.is_object()) return k_none;
  const auto found = j.find(key);
  return found == j.end() ? k_none : *found;
}
std::string text_in(const nlohmann::json& j, const char* key) {
  const auto& m = member_of(j, key);
  return m.is_string() ? m.get<std::string>() : std::string();
}
template <class Whole>
Whole require_whole(const nlohmann::json& j, const char* key, const Where& where) {
  const auto& m = member_of(j, key);
  const bool beyond = m.is_number_unsigned() && m.get<std::uint64_t>() > INT64_MAX,
             negative =
                 !m.is_number_unsigned() && m.is_number_integer() && m.get<std::int64_t>() < 0;
  const bool fits = m.is_number_integer() && !(std::is_unsigned_v<Whole> ? negative : beyond);
  if (!fits)
    throw Error(where, msg("'{}' is no whole number in its range", key), msg("use an intact copy"));
  return m.get<Whole>();
}
template std::int64_t require_whole(const nlohmann::json&, const char*, const Where&);
template std::uint64_t require_whole(const nlohmann::json&, const char*, const Where&);
std::int64_t whole_in(const nlohmann::json& j, const char* key) {
  const auto& m = member_of(j, key);
  return m.is_number_integer() && !(m.is_number_unsigned() && m.get<std::uint64_t>() > INT64_MAX)
             ? m.get<std::int64_t>()
             : 0;
}

}  // namespace cavum
