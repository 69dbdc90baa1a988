// Text as people and files need it: numbers in words, names that can be shown anywhere, and text made safe for
// one line of a terminal or for XML, whatever bytes a damaged file or a foreign file name holds.
#pragma once

#include <string>
#include <string_view>

namespace cavum {

/// True for valid UTF-8 without control characters (line ends and tabs are control characters).
[[nodiscard]] bool is_plain_text(std::string_view text) noexcept;
/// The same text on one line of valid UTF-8: control characters become spaces, bytes that are no UTF-8 become '?'.
[[nodiscard]] std::string one_line(std::string_view text);
/// Text for XML and HTML, in elements and attributes: & < > " ' and line ends as references; other control characters
/// and bytes that are no UTF-8, which XML does not know, become '?'.
[[nodiscard]] std::string xml_text(std::string_view text);

/// 3.5 as "3.5", 60.0 as "60"; six digits at most.
[[nodiscard]] std::string plain_number(double v);
/// With exactly `digits` digits after the point.
[[nodiscard]] std::string fixed(double v, int digits);

}  // namespace cavum
