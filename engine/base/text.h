// Text as people and files need it: numbers in words, names that can be shown anywhere, and text
// made safe for one line of a terminal or for XML, whatever bytes a damaged file or a foreign file
// name holds.
#pragma once

#include <string>
#include <string_view>

namespace cavum {

// A control character here is one of C0 or C1 (line ends, tabs and escapes are), a line or
// paragraph separator, or one that turns the direction of what follows (U+202A to 202E, U+2066 to
// 2069), with which "fail" can be made to read as something else.

/// True for valid UTF-8 without control characters.
[[nodiscard]] bool is_plain_text(std::string_view text) noexcept;
/// True for plain text in which something can be seen: not blanks, joiners and other characters
/// without a picture alone.
[[nodiscard]] bool is_seen_text(std::string_view text) noexcept;
/// True where a blank other than a space, or a character without a picture, stands in it: two texts
/// that look alike may differ by it.
[[nodiscard]] bool holds_unseen(std::string_view text) noexcept;
/// The same text on one line of valid UTF-8: control characters become spaces, bytes that are no
/// UTF-8 become '?'.
[[nodiscard]] std::string one_line(std::string_view text);
/// Text for XML and HTML, in elements and attributes: & < > " ' and line ends as references; other
/// control characters, bytes that are no UTF-8 and the two noncharacters that XML does not know
/// become '?'.
[[nodiscard]] std::string xml_text(std::string_view text);

/// A field of a CSV file: on one line, quoted where it must be, and never a formula to a
/// spreadsheet that opens it, whether that splits at commas, tabs or semicolons: what begins like
/// one (= + - @, wide ones too) has an apostrophe before it. A negative number is no formula.
[[nodiscard]] std::string csv_field(std::string_view text);
/// The beginning of `text` that ends with a whole character: all of it, or all but the first bytes
/// of one that is still to come.
[[nodiscard]] std::size_t whole_characters(std::string_view text) noexcept;
/// Text that was laid out for a terminal, with '?' for all that could move its cursor, change its
/// look or turn what follows: control characters other than line ends, tabs and returns to the
/// beginning of the line, and bytes that are no UTF-8.
[[nodiscard]] std::string terminal_text(std::string_view text);
/// JSON for a terminal: control characters above ASCII, which JSON does not escape, as \u escapes.
/// It reads the same.
[[nodiscard]] std::string terminal_json(std::string_view json);

/// Marks words that are shown to people later, in their language: the catalogue of messages takes
/// them from here (docs/languages.md).
[[nodiscard]] constexpr const char* noop(const char* english) noexcept { return english; }

/// 3.5 as "3.5", 60.0 as "60"; six digits at most.
[[nodiscard]] std::string plain_number(double v);
/// With exactly `digits` digits after the point.
[[nodiscard]] std::string fixed(double v, int digits);

}  // namespace cavum
