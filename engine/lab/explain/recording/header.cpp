#include "engine/lab/explain/recording/header.h"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/base/csv.h"
#include "engine/base/text.h"
#include "engine/lab/explain/recording/units.h"

namespace cavum::explain {
namespace {

constexpr std::size_t k_max_listed = 20;
constexpr std::size_t k_longest_compared = 64;

std::string trimmed(std::string_view text) { return std::string(without_blanks(text)); }

/// "name [unit]" or "name (unit)".
bool take_bracketed(HeaderName& h) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, {'(', ')'}, {'{', '}'}, {'<', '>'}}) {
    if (h.whole.empty() || h.whole.back() != close) continue;
    const std::size_t at = h.whole.rfind(open);
    if (at == std::string::npos || at == 0) continue;
    h.name = trimmed(std::string_view(h.whole).substr(0, at));
    h.unit = trimmed(std::string_view(h.whole).substr(at + 1, h.whole.size() - at - 2));
    h.marked = !h.unit.empty() && h.unit != "-";
    if (!h.marked) h.unit.clear();
    return true;
  }
  return false;
}

/// "name/unit", "name, unit", "name in unit"; what is behind must be a unit, for / and commas stand
/// in names, too.
bool take_parted(HeaderName& h) {
  for (const std::string_view mark : {" in ", ", ", ",", " / ", " ", "/"})
    if (const std::size_t at = h.whole.find(mark); at != std::string::npos && at > 0) {
      const std::string unit = trimmed(std::string_view(h.whole).substr(at + mark.size()));
      if (!is_unit(unit)) continue;
      h.name = trimmed(std::string_view(h.whole).substr(0, at));
      h.unit = unit;
      h.marked = true;
      return true;
    }
  return false;
}

/// "name_unit", "name_mm_s".
void take_ending(HeaderName& h) {
  std::size_t at = h.whole.size();
  std::vector<std::size_t> marks;
  while (marks.size() < 2 && at > 0 &&
         (at = h.whole.find_last_of("_-", at - 1)) != std::string::npos && at > 0)
    marks.push_back(at);
  for (auto mark = marks.rbegin(); mark != marks.rend(); ++mark) {
    const std::string unit = h.whole.substr(*mark + 1);
    if (!is_unit(unit)) continue;
    h.name = h.whole.substr(0, *mark);
    h.unit = unit;
    return;
  }
}

/// Damerau's distance, of neighbours exchanged at most once.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before, above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = std::exchange(above, row);
  }
  return above[b.size()];
}

}  // namespace

std::string header_text(std::string_view bytes) {
  std::string as_it_is = one_line(bytes);  // bytes that are no UTF-8 are ? there
  if (std::count(as_it_is.begin(), as_it_is.end(), '?') ==
      std::count(bytes.begin(), bytes.end(), '?'))
    return as_it_is;
  std::string utf8;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      utf8 += c;
    } else {
      utf8 += static_cast<char>(0xc0U | (byte >> 6U));
      utf8 += static_cast<char>(0x80U | (byte & 0x3fU));
    }
  }
  return one_line(utf8);
}

HeaderName read_header_name(std::string_view cell, std::string_view line_unit) {
  HeaderName h;
  h.whole = header_text(cell);
  h.name = h.whole;
  if (!take_bracketed(h) && !take_parted(h)) take_ending(h);
  std::string below = header_text(line_unit);
  if (below.size() > 1 && ((below.front() == '[' && below.back() == ']') ||
                           (below.front() == '(' && below.back() == ')')))
    below = below.substr(1, below.size() - 2);
  if (!below.empty() && below != "-" && below != "--") {
    h.unit = below;
    h.marked = true;
  }
  return h;
}

std::string plain_letters(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, char>, 14> k_marked{{{"\xc3\xa4", 'a'},
                                                                        {"\xc3\x84", 'a'},
                                                                        {"\xc3\xb6", 'o'},
                                                                        {"\xc3\x96", 'o'},
                                                                        {"\xc3\xbc", 'u'},
                                                                        {"\xc3\x9c", 'u'},
                                                                        {"\xc3\xa9", 'e'},
                                                                        {"\xc3\x89", 'e'},
                                                                        {"\xc3\xa8", 'e'},
                                                                        {"\xc3\xa0", 'a'},
                                                                        {"\xc3\xa1", 'a'},
                                                                        {"\xc3\xad", 'i'},
                                                                        {"\xc3\xb3", 'o'},
                                                                        {"\xc3\xb1", 'n'}}};
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) out += c;
    if (c >= 'A' && c <= 'Z') out += static_cast<char>(c - 'A' + 'a');
    for (const auto& [letter, plain] : k_marked)
      if (name.substr(i).starts_with(letter)) out += plain;
  }
  return out;
}

std::optional<std::string> nearest_name(const std::vector<std::string>& names,
                                        std::string_view wanted) {
  const std::string meant = plain_letters(wanted.substr(0, k_longest_compared));
  std::optional<std::string> best;
  std::size_t least = 1000;
  for (const std::string& name : names) {
    const std::string letters = plain_letters(std::string_view(name).substr(0, k_longest_compared));
    const std::size_t longer = std::max(letters.size(), meant.size()), d = distance(letters, meant);
    if (longer == 0 || 3 * d > longer || d >= least) continue;
    least = d;
    best = name;
  }
  return best;
}

Message list_of_names(const std::vector<std::string>& names) {
  List list;
  for (std::size_t i = 0; i < names.size() && i < k_max_listed; ++i)
    list.items.push_back(msg("'{}'", one_line(names[i])));
  return names.size() > k_max_listed ? msg("{} and {} more", list, names.size() - k_max_listed)
                                     : msg("{}", list);
}

}  // namespace cavum::explain
