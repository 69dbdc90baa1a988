// What can be said of a rubric beside an exam: measures of things that the exam does not have,
// which everybody would have full marks for, and criteria that are turned round, or charge one
// mistake twice.
#pragma once

#include <vector>

#include "scenarios/file/parse.h"

namespace cavum::scenarios {

/// A mistake for each criterion whose measure asks for what this exam does not have: a tissue of
/// the tooth, something protected, a leeway or container of that side, an aim or a fault under
/// [perforation], a force limit. In the order of the rubric.
[[nodiscard]] std::vector<Problem> not_in_this_exam(const RubricSpec& rubric,
                                                    const Scenario& scenario, const Tooth& tooth);

/// A warning for each criterion that gives its full marks to the worse value.
[[nodiscard]] std::vector<Problem> turned_round(const RubricSpec& rubric);

/// A warning for each two criteria with points whose measures count the same tissue or the same
/// ticks, unless one of them names the other under `shares_with`: one mistake costs twice there,
/// which is the author's to want.
[[nodiscard]] std::vector<Problem> charged_twice(const RubricSpec& rubric);

}  // namespace cavum::scenarios
