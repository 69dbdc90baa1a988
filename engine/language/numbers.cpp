#include "engine/language/numbers.h"

#include <algorithm>
#include <unordered_set>

#include "engine/base/figures.h"
#include "engine/language/catalogue.h"

namespace cavum {

namespace {
bool is_digit(char c) { return c >= '0' && c <= '9'; }
}  // namespace

bool is_number(std::string_view text) {
  static const std::unordered_set<std::string_view> k_beside{"mm", "mm²", "mm³", "mm2", "mm3", "s",   "ms", "µs", "N",  "%",    "°",      "±",   "/",
                                                             "–",  "-",   "rpm", "min", "Hz",  "kHz", "x",  "×",  "µm", "N/mm", "N·s/mm", "mm/s"};
  bool any = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    std::string_view word = text.substr(at, end - at);
    at = end + 1;
    if (word.empty() || k_beside.contains(word)) continue;
    while (!word.empty() && (word.front() == '(' || word.front() == '[')) word.remove_prefix(1);
    if (word.starts_with("\u2212")) word.remove_prefix(3);
    if (word.starts_with("±")) word.remove_prefix(2);
    if (!word.empty() && (word.front() == '+' || word.front() == '-')) word.remove_prefix(1);
    while (!word.empty() && (word.back() == ',' || word.back() == ';' || word.back() == '%' || word.back() == ')' || word.back() == ']'))
      word.remove_suffix(1);
    if (word.ends_with("°")) word.remove_suffix(2);
    const std::size_t dot = word.find('.');
    if (word.empty() || !is_digit(word.front()) || !is_digit(word.back())) return false;
    if (!std::all_of(word.begin(), word.end(), [](char c) { return is_digit(c) || c == '.'; }) ||
        (dot != word.npos && word.find('.', dot + 1) != word.npos))
      return false;
    any = true;
  }
  return any;
}

std::string with_decimal_sign(std::string_view text) {
  std::string out(text);
  for (std::size_t i = 1; i + 1 < out.size(); ++i)
    if (out[i] == '.' && is_digit(out[i - 1]) && is_digit(out[i + 1])) out[i] = catalogue().decimal_sign();
  // a list of numbers keeps its parts apart
  if (catalogue().decimal_sign() == ',')
    for (std::size_t i = 1; i + 1 < out.size(); ++i)
      if (out[i] == ',' && out[i + 1] == ' ') out[i] = ';';
  return with_unit_signs(std::move(out));
}

std::string with_decimal_signs_in(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string_view word = text.substr(at, end - at);
    out += is_number(word) ? with_decimal_sign(word) : std::string(word);
    if (end < text.size()) out += ' ';
    at = end + 1;
  }
  return out;
}

}  // namespace cavum
