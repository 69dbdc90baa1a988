// How a file writes its numbers: with a decimal point or a decimal comma. Separators of thousands
// are refused, not guessed.
#pragma once

#include <optional>
#include <string_view>

namespace cavum::explain {

enum class Decimal { point, comma };

/// The number that is all of a cell, finite; a + or the sign U+2212 before it is allowed. None when
/// it is no number.
[[nodiscard]] std::optional<double> number_in(std::string_view cell, Decimal decimal) noexcept;
/// True for an empty cell, and for nan, NA, -, --- and their like.
[[nodiscard]] bool is_missing(std::string_view cell) noexcept;

/// What a cell says of how its file writes numbers.
enum class NumberSign {
  none,      ///< no number, or a whole one
  point,     ///< 1.5
  comma,     ///< 1,5
  thousands  ///< 1.234,5 or 1,234.5 or 1,234,567 or 1'234
};
[[nodiscard]] NumberSign number_sign(std::string_view cell) noexcept;

}  // namespace cavum::explain
