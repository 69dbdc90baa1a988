#include "grading/ledger/csv.h"

#include <string_view>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

constexpr std::size_t k_most_fields = 100, k_most_rows = 20'000;  // each row may ask a database

/// Spaces around a field that was not in quotes mean nothing.
std::string trimmed(const std::string& s) {
  const auto from = s.find_first_not_of(" \t"), to = s.find_last_not_of(" \t");
  return from == std::string::npos ? std::string() : s.substr(from, to - from + 1);
}

/// The one that stands more often outside quotes.
char separator_of(std::string_view heading) {
  int commas = 0, semicolons = 0;
  bool quoted = false;
  for (const char c : heading) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    commas += c == ',' ? 1 : 0;
    semicolons += c == ';' ? 1 : 0;
  }
  return semicolons > commas ? ';' : ',';
}

}  // namespace

std::vector<CsvRow> parse_csv(const std::string& whole, const std::string& where) {
  constexpr std::string_view k_mark = "\xef\xbb\xbf";
  std::string_view text = whole;
  if (text.starts_with(k_mark)) text.remove_prefix(k_mark.size());
  const char separator = separator_of(text.substr(0, text.find_first_of("\r\n")));

  std::vector<CsvRow> rows;
  int line = 1;
  const auto fail = [&](int at, const std::string& what, const std::string& to_do) { throw Error(where + ":" + std::to_string(at), what, to_do); };
  for (std::size_t i = 0; i < text.size();) {
    CsvRow row{line, {}};
    std::string field;
    bool quoted = false, was_quoted = false, any = false;
    for (; i < text.size(); ++i) {
      const char c = text[i];
      if (quoted) {
        if (c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
          field += '"';
          ++i;
        } else if (c == '"') {
          quoted = false;
        } else {
          if (c == '\n') ++line;
          field += c;
        }
        continue;
      }
      if (c == '"' && trimmed(field).empty()) {
        field.clear();
        quoted = was_quoted = any = true;
      } else if (c == separator) {
        row.fields.push_back(was_quoted ? field : trimmed(field));
        if (row.fields.size() >= k_most_fields)
          fail(line, "has more than " + std::to_string(k_most_fields) + " fields", "leave out what is not asked for");
        field.clear();
        was_quoted = false;
        any = true;
      } else if (c == '\n' || c == '\r') {
        break;
      } else {
        field += c;
        any = any || (c != ' ' && c != '\t');
      }
    }
    if (quoted) fail(row.line, "begins a quote that does not end", "close it with \"");
    row.fields.push_back(was_quoted ? field : trimmed(field));
    if (i < text.size()) {
      if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') ++i;
      ++i;
      ++line;
    }
    if (!any || row.fields[0].starts_with('#')) continue;
    for (const auto& f : row.fields)
      if (!is_plain_text(f)) fail(row.line, "is no UTF-8 text, or holds a control character", "save the table as CSV UTF-8");
    if (!rows.empty() && row.fields.size() != rows[0].fields.size())
      fail(row.line, "has " + std::to_string(row.fields.size()) + " fields, the heading " + std::to_string(rows[0].fields.size()),
           "give each row all of them");
    if (rows.size() > k_most_rows) fail(row.line, "is beyond the limit of " + std::to_string(k_most_rows) + " rows", "split the table");
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace cavum
