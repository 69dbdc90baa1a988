// The rows of a table whose form is known, one after the other: comments and blank lines passed
// over, cells counted, limits kept.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"
#include "engine/lab/explain/recording/table_form.h"

namespace cavum::explain {

/// Most rows, columns and sessions of a recording.
inline constexpr std::size_t k_max_recording_rows =
    5'000'000;  ///< 7 hours at 200 Hz; beyond that memory, not time, is the limit
inline constexpr std::size_t k_max_columns = 200;
inline constexpr std::size_t k_max_sessions = 1000;

class RowReader {
 public:
  /// `text` is kept by the caller. Reads the header. Errors name `where`:line.
  RowReader(std::string_view text, std::string where, const TableForm& form);

  /// Cells of the header, and of the line of units below it (as many, empty where there is none).
  [[nodiscard]] const std::vector<std::string>& header() const noexcept { return header_; }
  [[nodiscard]] const std::vector<std::string>& units() const noexcept { return units_; }
  /// Goes on to the next row. False at the end. Throws Error for a row with more or fewer cells
  /// than the header (an empty last one apart), for a quote that does not end, and beyond the
  /// limits.
  bool next();
  /// Of the row; they live as long as the text.
  [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept { return cells_; }
  /// "where:line".
  [[nodiscard]] std::string at() const;
  [[noreturn]] void fail(ErrorCode code, const Message& what, const Message& what_to_do) const;

 private:
  bool next_line();

  std::string_view text_;
  std::string where_;
  TableForm form_;
  std::size_t at_ = 0, rows_ = 0;
  int line_ = 0, next_ = 1;
  std::vector<std::string> header_, units_;
  std::vector<std::string_view> cells_;
};

}  // namespace cavum::explain
