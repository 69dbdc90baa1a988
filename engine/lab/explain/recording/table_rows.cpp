#include "engine/lab/explain/recording/table_rows.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/csv.h"
#include "engine/base/error.h"
#include "engine/base/file_error.h"

namespace cavum::explain {

RowReader::RowReader(std::string_view text, std::string where, const TableForm& form)
    : text_(text),
      where_(std::move(where)),
      form_(form),
      at_(form.header_at),
      next_(form.header_line) {
  if (!next_line())
    throw Error(FileError::missing, Name{where_}, msg("is empty"),
                msg("give a CSV with a header such as session,t_s,x_mm,f_n"));
  header_.assign(cells_.begin(), cells_.end());
  while (header_.size() > 1 && header_.back().empty())
    header_.pop_back();  // a separator at the end of the line
  units_.assign(header_.size(), "");
  if (!form_.unit_line || !next_line()) return;
  for (std::size_t i = 0; i < std::min(units_.size(), cells_.size()); ++i) units_[i] = cells_[i];
}

std::string RowReader::at() const { return fmt::format("{}:{}", where_, line_); }

void RowReader::fail(ErrorCode code, const Message& what, const Message& what_to_do) const {
  throw Error(code, Name{at()}, what, what_to_do);
}

bool RowReader::next_line() {
  while (at_ < text_.size()) {
    line_ = next_++;
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    at_ = end + (text_.substr(end).starts_with("\r\n") ? 2U : 1U);
    if (without_blanks(line).empty() || is_comment_line(line)) continue;
    bool closed = true;
    split_line(line, form_.separator, k_max_columns, cells_, closed);
    if (!closed)
      fail(FileError::malformed, msg("begins a quote that does not end"),
           msg("close it with \" on the same line"));
    if (cells_.size() > k_max_columns)
      fail(FileError::too_large, msg("has more than {} cells", k_max_columns),
           msg("leave out what is not asked for"));
    return true;
  }
  return false;
}

bool RowReader::next() {
  if (!next_line()) return false;
  while (cells_.size() > header_.size() && cells_.back().empty()) cells_.pop_back();
  if (cells_.size() != header_.size())
    fail(FileError::inconsistent, msg("has {} cells for {} columns", cells_.size(), header_.size()),
         msg("complete the row"));
  if (rows_++ == k_max_recording_rows)
    fail(FileError::too_large, msg("is beyond the limit of {} rows", k_max_recording_rows),
         msg("split the table"));
  return true;
}

}  // namespace cavum::explain
