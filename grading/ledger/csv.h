// CSV as spreadsheets write it: fields in quotes, comma or semicolon (whichever the heading uses more), any line ends, a byte order mark.
#pragma once

#include <string>
#include <vector>

namespace cavum {

struct CsvRow {
  int line = 0;  ///< where it begins, from 1
  std::vector<std::string> fields;
};
/// Rows that are neither empty nor comments (#). Throws Error(where:line, ...) for text that is no UTF-8, a quote that does not close, or a row
/// with more or fewer fields than the first.
[[nodiscard]] std::vector<CsvRow> parse_csv(const std::string& text, const std::string& where);

}  // namespace cavum
