// An enum whose values have the names by which files and programs know them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#define CAVUM_ENUM_VALUE(NAME, ...) NAME,
#define CAVUM_ENUM_NAME(NAME, ...) std::string_view(#NAME),
/// LIST(ROW) is a list of ROW(name, ...); names_of(TYPE{}) are the names, by value.
#define CAVUM_NAMED_ENUM(TYPE, LIST)                         \
  enum class TYPE : std::uint8_t { LIST(CAVUM_ENUM_VALUE) }; \
  [[nodiscard]] constexpr auto names_of(TYPE) { return std::array{LIST(CAVUM_ENUM_NAME)}; }

namespace cavum {

/// Of any enum with names_of.
template <class E>
[[nodiscard]] constexpr auto name_in(E value) {
  return names_of(value)[static_cast<std::size_t>(value)];
}

}  // namespace cavum
