// Figures as people read them: a clock's text, and units with their signs.
#pragma once

#include <string>

namespace cavum {

/// A clock's text: "1:05" for 65.9 s. The second has begun and is not over, as on any clock; below 0 it is "0:00". Time that is left is rounded up
/// by who asks.
[[nodiscard]] std::string clock_text(double seconds);
/// "0.30 ± 0.04 mm³" for "0.30 ± 0.04 mm3": results and files say mm3 and mm2, people read mm³ and mm².
[[nodiscard]] std::string with_unit_signs(std::string text);

}  // namespace cavum
