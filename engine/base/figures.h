// Figures as people read them: a clock's text.
#pragma once

#include <string>

namespace cavum {

/// A clock's text: "1:05" for 65.9 s. The second has begun and is not over, as on any clock; below
/// 0 it is "0:00". Time that is left is rounded up by who asks.
[[nodiscard]] std::string clock_text(double seconds);

}  // namespace cavum
