// How a table of numbers is laid out, found from its first lines: what a machine writes before the
// header, what parts the cells, whether units stand on a line below the header, whether numbers
// have a decimal comma.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/lab/explain/recording/number_form.h"

namespace cavum::explain {

struct TableForm {
  char separator = ',';  ///< , ; tab, or a blank for runs of white space
  Decimal decimal = Decimal::point;
  std::size_t header_at = 0;        ///< byte of the text at which the header's line begins
  int header_line = 1;              ///< from 1
  bool unit_line = false;           ///< the line below the header holds units
  std::vector<std::string> before;  ///< lines before the header that are no comments, at most 50
};

/// Most lines before the header.
inline constexpr std::size_t k_max_lines_before = 50;

/// Lines of blanks and those that begin with #, % or // are passed over. The header is the first
/// line of names with a line of as many cells below it, two of them numbers or stamps. Throws
/// Error(where:line, ...) for a table without a header, for decimal commas in a table parted by
/// commas, for numbers with separators of thousands, and for both decimal signs in one table. Where
/// nothing is found, the first line is the header.
[[nodiscard]] TableForm find_table_form(std::string_view text, const std::string& where);

/// True for a line that is a comment: it begins with #, % or //.
[[nodiscard]] bool is_comment_line(std::string_view line) noexcept;
/// The cells of one line, without blanks around them and without quotes; a quote inside quotes is
/// doubled. `closed`: false when a quote does not end. Cells that hold a doubled quote keep both.
/// At most `most` + 1 are returned.
void split_line(std::string_view line, char separator, std::size_t most,
                std::vector<std::string_view>& cells, bool& closed);

}  // namespace cavum::explain
