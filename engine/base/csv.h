// Tables as spreadsheets and rigs write them (CSV): one row on a line, fields parted by comma,
// semicolon or tab (where asked for, a bar), fields in quotes, any line ends, a byte order mark,
// comments (#). Read row by row, so that a recording of millions of rows takes no more memory than
// its numbers.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"

namespace cavum {

/// What a table may hold.
struct CsvForm {
  std::size_t most_fields = 100;   ///< of a row
  std::size_t most_rows = 20'000;  ///< below the heading
  bool quotes = true;              ///< false: a quote is a character like any other
  bool plain_text = true;  ///< refuses fields that are no UTF-8, or hold a control character
  bool bars = false;       ///< a bar (|) may part the fields, too
  bool uneven = false;  ///< gives rows with more or fewer fields than the heading has as they are
};

/// Throws Error(where, ...) for a text that begins as UTF-16 does.
void refuse_utf16(std::string_view text, const std::string& where);

/// Goes through a table. The first row is the heading: what stands there most often, outside
/// quotes, of comma, semicolon and tab (`bars`: or bar) parts the fields of all rows, and each row
/// has as many fields. A first line `sep=;`, as spreadsheets write and read it, names what parts
/// them instead: any ASCII character that is no letter, digit or quote.
class CsvReader {
 public:
  enum class Line { row, comment, end };

  /// `text` is kept by the caller. Errors name `where`:line.
  CsvReader(std::string_view text, std::string where, const CsvForm& form = {});

  /// Goes on to the next row or comment; lines of blanks are passed over. Throws Error(where:line,
  /// ...) for a quote that does not close, for more fields or rows than the form has, for a row
  /// with more or fewer fields than the heading, and where the form asks for it for what is no
  /// plain text.
  Line next();
  /// The same, comments passed over. False at the end.
  bool next_row();

  /// Of the row, without the blanks around them and without quotes; they live until the next call.
  [[nodiscard]] const std::vector<std::string_view>& fields() const noexcept { return fields_; }
  /// Of the comment, without # and the blanks around it.
  [[nodiscard]] std::string_view comment() const noexcept { return comment_; }
  /// Where it begins, from 1.
  [[nodiscard]] int line() const noexcept { return line_; }
  [[nodiscard]] std::string at() const;
  /// What parts the fields; known once the heading was read.
  [[nodiscard]] char separator() const noexcept { return separator_; }
  /// Throws Error(where:line, what, what_to_do).
  [[noreturn]] void fail(const Message& what, const Message& what_to_do) const {
    fail(General::error, what, what_to_do);
  }
  [[noreturn]] void fail(ErrorCode code, const Message& what, const Message& what_to_do) const;

 private:
  void read_row();
  std::string_view read_field();
  std::string_view read_quoted();
  std::string_view read_to_end_of_field();
  void end_line();
  void check_row();

  std::string_view text_;
  std::string where_;
  CsvForm form_;
  std::size_t at_ = 0;       // in text_
  int line_ = 0, next_ = 1;  // of the row, and of what follows
  char separator_ = 0;       // 0 before the heading
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<std::string_view> fields_;
  std::deque<std::string> unescaped_;  // fields whose text does not stand in text_ as it is
  std::string_view comment_;
};

struct CsvRow {
  int line = 0;  ///< where it begins, from 1
  std::vector<std::string> fields;
};
/// All rows of a small table, the heading first. Throws what CsvReader throws.
[[nodiscard]] std::vector<CsvRow> parse_csv(std::string_view text, const std::string& where,
                                            const CsvForm& form = {});

/// The same without spaces and tabs at its ends.
[[nodiscard]] std::string_view without_blanks(std::string_view text) noexcept;
/// The number that is all of a field, with a decimal point; a + before it is allowed. None when it
/// is no number, or not finite.
[[nodiscard]] std::optional<double> number_in_field(std::string_view field) noexcept;

}  // namespace cavum
