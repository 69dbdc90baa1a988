#include "engine/lab/explain/recording/table_form.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>

#include "engine/base/csv.h"
#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/text.h"
#include "engine/lab/explain/recording/date_time.h"
#include "engine/lab/explain/recording/units.h"

namespace cavum::explain {
namespace {

constexpr std::size_t k_max_lines = 400;       // that are looked at
constexpr std::size_t k_longest_line = 20000;  // bytes that are looked at
constexpr std::size_t k_max_cells = 200;
constexpr std::array k_separators{
    '\t', ';', ',', ' '};  // a table that can be read by two of them is read by the first

struct Line {
  std::size_t at = 0;
  int number = 0;
  std::string_view text;
};

using Cells = std::vector<std::string_view>;

std::vector<Line> first_lines(std::string_view text) {
  std::vector<Line> lines;
  int number = 1;
  for (std::size_t at = text.starts_with("\xef\xbb\xbf") ? 3 : 0;
       at < text.size() && lines.size() < k_max_lines; ++number) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    const std::string_view line = text.substr(at, end - at);
    if (!without_blanks(line).empty() && !is_comment_line(line))
      lines.push_back({at, number, line.substr(0, k_longest_line)});
    at = end + (text.substr(std::min(end, text.size())).starts_with("\r\n") ? 2 : 1);
  }
  return lines;
}

Cells cells_of(const Line& line, char separator) {
  Cells cells;
  bool closed = true;
  split_line(line.text, separator, k_max_cells, cells, closed);
  return cells;
}

bool is_number(std::string_view cell) {
  return number_in(cell, Decimal::point) || number_in(cell, Decimal::comma) ||
         number_sign(cell) != NumberSign::none;
}

/// Names, none of which is a number.
bool is_heading(const Cells& cells) {
  return cells.size() > 1 && std::none_of(cells.begin(), cells.end(), is_number) &&
         std::any_of(cells.begin(), cells.end(), [](auto c) { return !c.empty(); });
}

bool is_data(const Cells& cells) {
  const auto numbers = std::count_if(cells.begin(), cells.end(), is_number);
  const auto stamps =
      std::count_if(cells.begin(), cells.end(), [](auto c) { return looks_like_stamp(c); });
  return numbers + std::min<std::ptrdiff_t>(stamps, 1) > 1;
}

std::string_view unbracketed(std::string_view cell) {
  if (cell.size() > 1 &&
      ((cell.front() == '[' && cell.back() == ']') || (cell.front() == '(' && cell.back() == ')')))
    return cell.substr(1, cell.size() - 2);
  return cell;
}

/// Units and nothing else that is no word: at least half of what stands there.
bool is_unit_line(const Cells& cells) {
  const auto there =
      std::count_if(cells.begin(), cells.end(), [](auto c) { return !is_missing(unbracketed(c)); });
  const auto units =
      std::count_if(cells.begin(), cells.end(), [](auto c) { return is_unit(unbracketed(c)); });
  return units > 0 && 2 * units >= there && std::none_of(cells.begin(), cells.end(), is_number);
}

struct Place {
  std::size_t header = 0;
  bool unit_line = false;
};

/// The header under one separator.
std::optional<Place> header_under(const std::vector<Line>& lines, char separator) {
  for (std::size_t i = 0; i + 1 < lines.size() && i <= k_max_lines_before; ++i) {
    const Cells heading = cells_of(lines[i], separator), below = cells_of(lines[i + 1], separator);
    if (!is_heading(heading) || below.size() != heading.size()) continue;
    if (is_data(below)) return Place{i, false};
    if (!is_unit_line(below)) continue;
    if (i + 2 == lines.size()) return Place{i, true};
    const Cells next = cells_of(lines[i + 2], separator);
    if (next.size() == heading.size() && is_data(next)) return Place{i, true};
  }
  return std::nullopt;
}

/// Of comma, semicolon and tab what stands most often in the line; a blank where there is none of
/// them.
char most_frequent(std::string_view line) {
  char best = ',';
  std::ptrdiff_t most = 0;
  for (const char c : {',', ';', '\t'})
    if (const auto n = std::count(line.begin(), line.end(), c); n > most) most = n, best = c;
  return most > 0                                                              ? best
         : without_blanks(line).find_first_of(" \t") != std::string_view::npos ? ' '
                                                                               : ',';
}

[[noreturn]] void refuse(FileError code, const std::string& where, const Line& line,
                         const Message& what, const Message& what_to_do) {
  throw Error(code, FileLocation{where, static_cast<int>(line.number)}, what, what_to_do);
}

Decimal decimal_of(const std::vector<Line>& lines, std::size_t first, char separator,
                   const std::string& where) {
  std::optional<std::size_t> point, comma;
  for (std::size_t i = first; i < lines.size(); ++i)
    for (const std::string_view cell : cells_of(lines[i], separator)) {
      const NumberSign sign = number_sign(cell);
      if (sign == NumberSign::thousands)
        refuse(FileError::unsupported, where, lines[i],
               msg("'{}' has separators of thousands", one_line(cell)),
               msg("save the table without them; they are not guessed"));
      if (sign == NumberSign::point && !point) point = i;
      if (sign == NumberSign::comma && !comma) comma = i;
    }
  if (point && comma)
    refuse(FileError::inconsistent, where, lines[std::max(*point, *comma)],
           msg("numbers have a decimal point (line {}) and a decimal comma (line {})",
               lines[*point].number, lines[*comma].number),
           msg("save the table with one of them; if one parts the thousands, without it"));
  return comma ? Decimal::comma : Decimal::point;
}

/// A header that stands in a comment right above the numbers, as numpy writes it: where it begins,
/// behind the mark.
std::optional<Line> header_in_comment(std::string_view text, const Line& data, char separator) {
  const std::size_t end = text.substr(0, data.at).find_last_not_of("\r\n");
  if (end == std::string_view::npos ||
      std::count(text.begin() + static_cast<std::ptrdiff_t>(end),
                 text.begin() + static_cast<std::ptrdiff_t>(data.at), '\n') > 1)
    return std::nullopt;
  const std::size_t before = text.substr(0, end).find_last_of("\r\n"),
                    from = before == std::string_view::npos ? 0 : before + 1;
  const std::string_view line = text.substr(from, end + 1 - from);
  const std::size_t mark = line.find_first_of("#%/"),
                    behind = line.find_first_not_of("#%/ \t", mark);
  if (!is_comment_line(line) || mark == std::string_view::npos || behind == std::string_view::npos)
    return std::nullopt;
  const Line out{from + behind, data.number - 1, line.substr(behind)};
  const Cells heading = cells_of(out, separator);
  return is_heading(heading) && heading.size() == cells_of(data, separator).size()
             ? std::optional(out)
             : std::nullopt;
}

/// A table whose cells and decimals are both parted by commas has twice the cells that its header
/// has.
void refuse_commas_twice(const std::vector<Line>& lines, const std::string& where) {
  for (std::size_t i = 0; i + 1 < lines.size() && i <= k_max_lines_before; ++i) {
    const Cells heading = cells_of(lines[i], ','), below = cells_of(lines[i + 1], ',');
    if (is_heading(heading) && below.size() > heading.size() + 1 &&
        below.size() <= 2 * heading.size() && std::all_of(below.begin(), below.end(), is_number))
      refuse(FileError::unsupported, where, lines[i + 1],
             msg("has {} cells for {} columns: commas part the cells and the decimals",
                 below.size(), heading.size()),
             msg("save the table with semicolons or tabs between the cells"));
  }
}

}  // namespace

bool is_comment_line(std::string_view line) noexcept {
  line = without_blanks(line);
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//") ||
         line.starts_with("\"#");
}

void split_line(std::string_view line, char separator, std::size_t most, Cells& cells,
                bool& closed) {
  cells.clear();
  closed = true;
  const auto parts = [separator](char c) {
    return separator == ' ' ? c == ' ' || c == '\t' : c == separator;
  };
  const auto blank = [separator](char c) { return c == ' ' || (c == '\t' && separator != '\t'); };
  std::size_t at = 0;
  for (;;) {
    while (at < line.size() && blank(line[at])) ++at;
    if (separator == ' ' && at == line.size()) break;
    if (at < line.size() && line[at] == '"') {
      std::size_t end = line.find('"', at + 1);
      while (end != std::string_view::npos && line.substr(end).starts_with("\"\""))
        end = line.find('"', end + 2);
      closed = end != std::string_view::npos;
      cells.push_back(without_blanks(line.substr(at + 1, (closed ? end : line.size()) - at - 1)));
      at = closed ? end + 1 : line.size();
      while (at < line.size() && !parts(line[at])) ++at;
    } else {
      const std::size_t from = at;
      while (at < line.size() && !parts(line[at])) ++at;
      cells.push_back(without_blanks(line.substr(from, at - from)));
    }
    if (at == line.size() || cells.size() > most) break;
    ++at;
  }
}

TableForm find_table_form(std::string_view text, const std::string& where) {
  refuse_utf16(text, where);
  const std::vector<Line> lines = first_lines(text);
  if (lines.empty())
    throw Error(FileError::missing, Name{where}, msg("is empty"),
                msg("give a CSV with a header such as session,t_s,x_mm,f_n"));
  TableForm out;
  Place place;
  bool found = false;
  for (const char separator : k_separators)
    if (const auto here = header_under(lines, separator); here && !found) {
      place = *here;
      out.separator = separator;
      found = true;
    }
  if (!found) {
    out.separator = most_frequent(lines.front().text);
    if (is_data(cells_of(lines.front(), out.separator))) {
      for (const char separator : k_separators)
        if (const auto header = header_in_comment(text, lines.front(), separator)) {
          out.separator = separator;
          out.header_at = header->at;
          out.header_line = header->number;
          out.decimal = decimal_of(lines, 0, separator, where);
          return out;
        }
      refuse(FileError::missing, where, lines.front(), msg("begins with numbers, without a header"),
             msg("write names above them, such as session,t_s,x_mm,f_n"));
    }
    refuse_commas_twice(lines, where);
  }
  for (std::size_t i = 0; i < place.header; ++i) out.before.push_back(one_line(lines[i].text));
  out.header_at = lines[place.header].at;
  out.header_line = lines[place.header].number;
  out.unit_line = place.unit_line;
  out.decimal = decimal_of(lines, place.header + (place.unit_line ? 2 : 1), out.separator, where);
  return out;
}

}  // namespace cavum::explain
