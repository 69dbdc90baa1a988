// A lesson's sentences.
#pragma once

#include "grading/feedback/lessons.h"

namespace cavum::grading {

/// Row of an array by zone or by wall.
[[nodiscard]] constexpr std::size_t row_of(scenarios::Zone z) noexcept {
  return static_cast<std::size_t>(z);
}
[[nodiscard]] constexpr std::size_t row_of(scenarios::Wall w) noexcept {
  return static_cast<std::size_t>(w);
}

/// What must not be opened was reached through the floor: the same mistake as a floor that is too
/// deep.
[[nodiscard]] bool opened_through_floor(const GradeInput& in, const Result& r);

/// Fills in what `lesson` says of its topic, where and when to look.
void tell_lesson(Lesson& lesson, const GradeInput& input, const Result& result);

}  // namespace cavum::grading
