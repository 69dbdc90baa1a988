// Why a criterion lost points, in one line: what, how much, at which wall, when it began and where.
#pragma once

#include <string>

#include "grading/result/result.h"

namespace cavum {

struct Loss {
  std::string text;
  Trace first;  ///< where the loss began
};
[[nodiscard]] Loss loss_of(const Result& measured, const std::string& metric);

/// "0.30 ± 0.04 mm3"; a figure that is known exactly has no bound.
[[nodiscard]] std::string amount_text(double value, double bound, int digits, const std::string& unit);
/// "12.34 s (tick 12340)", "[1.00, 0.00, -2.00] mm", "the mesial wall".
[[nodiscard]] std::string when(const Trace& t);
[[nodiscard]] std::string place(Vec3 p);
[[nodiscard]] std::string wall_text(std::size_t wall);

}  // namespace cavum
