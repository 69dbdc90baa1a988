#include "engine/lab/explain/recording/number_form.h"

#include <algorithm>
#include <array>

#include "engine/base/csv.h"

namespace cavum::explain {
namespace {

constexpr std::string_view k_minus = "\xe2\x88\x92";
constexpr std::size_t k_longest_number = 60;

}  // namespace

std::optional<double> number_in(std::string_view cell, Decimal decimal) noexcept {
  const bool minus = cell.starts_with(k_minus);
  if (!minus && (decimal == Decimal::point || cell.find_first_of(",.") == std::string_view::npos))
    return number_in_field(cell);
  if (minus) cell.remove_prefix(k_minus.size());
  if (cell.size() > k_longest_number ||
      (decimal == Decimal::comma && cell.find('.') != std::string_view::npos))
    return std::nullopt;
  if (minus && (cell.starts_with('+') || cell.starts_with('-'))) return std::nullopt;
  std::array<char, k_longest_number> text{};
  std::transform(cell.begin(), cell.end(), text.begin(),
                 [&](char c) { return c == ',' && decimal == Decimal::comma ? '.' : c; });
  const std::optional<double> number = number_in_field({text.data(), cell.size()});
  return number && minus ? std::optional(-*number) : number;
}

bool is_missing(std::string_view cell) noexcept {
  constexpr std::array<std::string_view, 10> k_words{"",    "nan", "NaN", "NAN", "NA",
                                                     "n/a", "N/A", "-",   "--",  "---"};
  return std::find(k_words.begin(), k_words.end(), cell) != k_words.end();
}

NumberSign number_sign(std::string_view cell) noexcept {
  if (cell.starts_with(k_minus)) cell.remove_prefix(k_minus.size());
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  const std::size_t exponent = std::min(cell.find_first_of("eE"), cell.size());
  const std::string_view digits = cell.substr(0, exponent);
  if (digits.empty() || digits.find_first_not_of("0123456789.,'") != std::string_view::npos)
    return NumberSign::none;
  const auto points = std::count(digits.begin(), digits.end(), '.'),
             commas = std::count(digits.begin(), digits.end(), ',');
  if (digits.find('\'') != std::string_view::npos) return NumberSign::thousands;
  if (points > 1 && commas == 0) return NumberSign::none;  // a date
  if ((points > 0 && commas > 0) || commas > 1) return NumberSign::thousands;
  if (points == 1) return NumberSign::point;
  return commas == 1 ? NumberSign::comma : NumberSign::none;
}

}  // namespace cavum::explain
