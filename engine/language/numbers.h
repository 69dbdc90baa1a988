// Numbers among words, and their signs in the reader's language.
#pragma once

#include <string>
#include <string_view>

namespace cavum {

/// Numbers with their units and signs and nothing else: "0.30 ± 0.02 mm", "[1.00, 0.00, -2.00] mm".
[[nodiscard]] bool is_number(std::string_view text);
/// Such a text with the language's decimal sign, a list's parts still apart, and mm³ for mm3.
[[nodiscard]] std::string with_decimal_sign(std::string_view text);
/// The same of the numbers among marks and spaces: of a row whose identifier was taken out, say. "0.2.0" is none.
[[nodiscard]] std::string with_decimal_signs_in(std::string_view text);

}  // namespace cavum
