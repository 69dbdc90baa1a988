#include "engine/base/csv.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

constexpr std::string_view k_byte_order_mark = "\xef\xbb\xbf";
constexpr std::string_view k_line_ends = "\r\n";

std::string_view text_of_comment(std::string_view s) {
  s.remove_prefix(std::min(s.find_first_not_of('#'), s.size()));
  return without_blanks(s);
}

/// What `sep=;` or `"sep=;"` names; 0: the line is none of these.
char named_separator(std::string_view line) {
  if (line.size() == 7 && line.front() == '"' && line.back() == '"') line = line.substr(1, 5);
  constexpr std::string_view k_names = "sep=", k_capitals = "SEP=";
  if (line.size() != k_names.size() + 1) return 0;
  for (std::size_t i = 0; i < k_names.size(); ++i)
    if (line[i] != k_names[i] && line[i] != k_capitals[i]) return 0;
  const char c = line.back();
  const bool word = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  return word || c == '"' || (c < ' ' && c != '\t') || c > '~' ? '\0' : c;
}

/// Of comma, semicolon, tab and, where a form has them, bar the one that stands most often outside
/// quotes; the earlier of equals.
char separator_of(std::string_view heading, const CsvForm& form) {
  constexpr std::string_view k_separators = ",;\t|";
  std::size_t times[k_separators.size()] = {};
  bool quoted = false;
  for (const char c : heading) {
    if (form.quotes && c == '"') quoted = !quoted;
    if (const auto i = k_separators.find(c);
        !quoted && (c != '|' || form.bars) && i != std::string_view::npos)
      ++times[i];
  }
  return k_separators[static_cast<std::size_t>(
      std::max_element(times, times + k_separators.size()) - times)];
}

}  // namespace

void refuse_utf16(std::string_view text, const std::string& where) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw Error(FileError::unsupported, Name{where},
                msg("is in UTF-16, as spreadsheets write 'Unicode text'"),
                msg("save it as CSV in UTF-8"));
}

CsvReader::CsvReader(std::string_view text, std::string where, const CsvForm& form)
    : text_(text), where_(std::move(where)), form_(form) {
  refuse_utf16(text_, where_);
  if (text_.starts_with(k_byte_order_mark)) text_.remove_prefix(k_byte_order_mark.size());
}

std::string CsvReader::at() const { return fmt::format("{}:{}", where_, line_); }

void CsvReader::fail(ErrorCode code, const Message& what, const Message& what_to_do) const {
  throw Error(code, FileLocation{where_, line_}, what, what_to_do);
}

bool CsvReader::next_row() {
  for (;;) {
    const Line found = next();
    if (found != Line::comment) return found == Line::row;
  }
}

CsvReader::Line CsvReader::next() {
  while (at_ < text_.size()) {
    line_ = next_;
    const std::string_view line =
        text_.substr(at_, std::min(text_.find_first_of(k_line_ends, at_), text_.size()) - at_);
    if (line_ == 1 && separator_ == 0 && (separator_ = named_separator(line)) != 0) {
      at_ += line.size();
      end_line();
      continue;
    }
    const std::string_view content = without_blanks(line);
    if (content.empty() || content.front() == '#') {
      at_ += line.size();
      end_line();
      if (content.empty()) continue;
      comment_ = text_of_comment(content);
      return Line::comment;
    }
    if (separator_ == 0) separator_ = separator_of(line, form_);
    read_row();
    if (fields_.front().starts_with('#')) {  // as a spreadsheet saves a comment with a comma in it
      comment_ = text_of_comment(fields_.front());
      return Line::comment;
    }
    check_row();
    return Line::row;
  }
  return Line::end;
}

void CsvReader::read_row() {
  fields_.clear();
  unescaped_.clear();
  for (;;) {
    fields_.push_back(read_field());
    if (fields_.size() > form_.most_fields)
      fail(FileError::too_large, msg("has more than {} cells", form_.most_fields),
           msg("leave out what is not asked for"));
    if (at_ == text_.size() || text_[at_] != separator_) break;
    ++at_;
  }
  end_line();
}

std::string_view CsvReader::read_field() {
  while (at_ < text_.size() && text_[at_] != separator_ &&
         (text_[at_] == ' ' || text_[at_] == '\t'))
    ++at_;
  if (form_.quotes && at_ < text_.size() && text_[at_] == '"') return read_quoted();
  return read_to_end_of_field();
}

std::string_view CsvReader::read_to_end_of_field() {
  const std::size_t from = at_;
  while (at_ < text_.size() && text_[at_] != separator_ && text_[at_] != '\n' && text_[at_] != '\r')
    ++at_;
  return without_blanks(text_.substr(from, at_ - from));
}

std::string_view CsvReader::read_quoted() {
  const std::size_t from = ++at_;
  bool doubled = false;
  for (;; at_ += 2, doubled = true) {
    at_ = text_.find('"', at_);
    if (at_ == std::string_view::npos)
      fail(FileError::malformed, msg("begins a quote that does not end"), msg("close it with \""));
    if (!text_.substr(at_).starts_with("\"\"")) break;
  }
  const std::string_view inside = text_.substr(from, at_++ - from);
  next_ += static_cast<int>(std::count(inside.begin(), inside.end(), '\n'));
  const std::string_view after = read_to_end_of_field();
  if (!doubled && after.empty()) return inside;
  std::string& whole = unescaped_.emplace_back();
  for (std::size_t i = 0; i < inside.size(); ++i) {
    whole += inside[i];
    if (inside[i] == '"') ++i;
  }
  return whole += after;
}

void CsvReader::end_line() {
  if (at_ == text_.size()) return;
  at_ += text_.substr(at_).starts_with("\r\n") ? 2 : 1;
  ++next_;
}

void CsvReader::check_row() {
  if (form_.plain_text && !std::all_of(fields_.begin(), fields_.end(), is_plain_text))
    fail(FileError::malformed, msg("is no UTF-8 text, or holds a control character"),
         msg("save the table as CSV UTF-8"));
  if (columns_ == 0) {
    columns_ = fields_.size();
    return;
  }
  if (fields_.size() != columns_ && !form_.uneven)
    fail(FileError::inconsistent, msg("has {} cells for {} columns", fields_.size(), columns_),
         msg("complete the row"));
  if (rows_++ == form_.most_rows)
    fail(FileError::too_large, msg("is beyond the limit of {} rows", form_.most_rows),
         msg("split the table"));
}

std::vector<CsvRow> parse_csv(std::string_view text, const std::string& where,
                              const CsvForm& form) {
  CsvReader in(text, where, form);
  std::vector<CsvRow> rows;
  while (in.next_row()) rows.push_back({in.line(), {in.fields().begin(), in.fields().end()}});
  return rows;
}

std::string_view without_blanks(std::string_view s) noexcept {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!s.empty() && blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && blank(s.back())) s.remove_suffix(1);
  return s;
}

std::optional<double> number_in_field(std::string_view field) noexcept {
  if (field.starts_with('+') && !field.starts_with("+-")) field.remove_prefix(1);
  double v = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), v);
  if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(v))
    return std::nullopt;
  return v;
}

}  // namespace cavum
