// Facts: a kind, which programs ask for, and its values. A table says once for each kind its
// English sentence and the names of its values. Files keep kind and values; only a face makes the
// sentence.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/message.h"
#include "engine/base/named_enum.h"

namespace cavum {

struct FactRow {
  std::string_view name;
  std::size_t group;  ///< the kind that stands for its group; where there is none, itself
  const char* english;
  std::array<const char*, 6>
      values;  ///< their names; those beyond the sentence's gaps are for programs alone
  [[nodiscard]] constexpr std::size_t count() const noexcept {
    std::size_t n = 0;
    while (n < values.size() && values[n] != nullptr) ++n;
    return n;
  }
  /// Of the sentence: as many of the values, the first ones, stand in it.
  [[nodiscard]] constexpr std::size_t gaps() const noexcept {
    std::size_t n = 0;
    for (const char* c = english; *c != 0; ++c) n += *c == '{' ? 1 : 0;
    return n;
  }
};

#define CAVUM_FACT_ROW(KIND, GROUP, ENGLISH, ...) \
  FactRow{#KIND, static_cast<std::size_t>(GROUP), ENGLISH, {__VA_ARGS__}},
// NOLINTBEGIN(bugprone-macro-parentheses): the name of a type
/// TABLE(ROW) is a list of ROW(kind, group, English sentence, names of its values).
#define CAVUM_FACTS(TYPE, TABLE)                                                             \
  enum class TYPE : std::uint16_t { TABLE(CAVUM_ENUM_VALUE) };                               \
  [[nodiscard]] constexpr auto names_of(TYPE) { return std::array{TABLE(CAVUM_ENUM_NAME)}; } \
  inline constexpr auto k_rows_of_##TYPE = [] {                                              \
    using enum TYPE;                                                                         \
    return std::array{TABLE(CAVUM_FACT_ROW)};                                                \
  }();                                                                                       \
  static_assert(std::ranges::all_of(                                                         \
      k_rows_of_##TYPE, [](const FactRow& row) { return row.gaps() <= row.count(); }));      \
  [[nodiscard]] constexpr std::span<const FactRow> rows_of(TYPE) { return k_rows_of_##TYPE; }
// NOLINTEND(bugprone-macro-parentheses)

template <class Kind>
struct TableFact {
  Kind kind{};
  std::vector<Value> values;  ///< as many as its row names

  [[nodiscard]] const FactRow& row() const noexcept {
    return rows_of(kind)[static_cast<std::size_t>(kind)];
  }
  [[nodiscard]] Kind group() const noexcept { return static_cast<Kind>(row().group); }
  [[nodiscard]] Message message() const {
    return {row().english,
            nullptr,
            0,
            {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(row().gaps())}};
  }
  friend bool operator==(const TableFact&, const TableFact&) = default;
};

/// A fact of this kind: the compiler counts its values.
template <auto kind, class... A>
[[nodiscard]] TableFact<decltype(kind)> fact_of(A&&... values) {
  static_assert(sizeof...(A) == rows_of(kind)[static_cast<std::size_t>(kind)].count(),
                "the kind has another number of values");
  return {kind, {message_detail::value_of(std::forward<A>(values))...}};
}

/// What an error said among the values becomes a text, in English, and texts are cut: so files get
/// facts, and no sentence that has to be translated.
[[nodiscard]] std::vector<Value> kept(std::vector<Value> values);

/// {"kind", "values"}: each value by its name, as decode_value reads it.
[[nodiscard]] nlohmann::ordered_json encode(const FactRow& row, const std::vector<Value>& values);
/// For other programs: {"kind", "group", "values", "text"}.
[[nodiscard]] nlohmann::json fact_json(std::span<const FactRow> rows, std::size_t kind,
                                       const std::vector<Value>& values, const Message& message);
/// Its values, and of which of `rows` it is; further members may stand beside them. Throws
/// std::invalid_argument for another kind or other values.
[[nodiscard]] std::pair<std::size_t, std::vector<Value>> decode_fact(const nlohmann::json& json,
                                                                     std::span<const FactRow> rows);
template <class Kind>
[[nodiscard]] TableFact<Kind> decode_fact(const nlohmann::json& json) {
  auto [row, values] = decode_fact(json, rows_of(Kind{}));
  return {static_cast<Kind>(row), std::move(values)};
}

}  // namespace cavum
