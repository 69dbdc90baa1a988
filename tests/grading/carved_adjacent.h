// Work on a tooth that has something beside it, graded.
#pragma once

#include <memory>

#include "grading/marking/grade.h"
#include "tests/grading/carved.h"

namespace cavum::testing {

/// Work on a tooth that does not stand alone.
struct CarvedAdjacent : Carved {
  CarvedAdjacent(const std::string& scenario_toml, Tooth tooth)
      : Carved(scenario_toml, std::move(tooth)), apart(grading::take_apart(before)) {}
  /// Calls `use(input)` with all of it.
  template <class Use>
  auto with_input(const Use& use) const {
    const grading::WorkApart own = grading::take_apart(*apart, after, removed);
    const grading::AdjacentInput beside{*apart, before, after, removed};
    return use(grading::GradeInput{scenario, apart->own, zones, own.after, inputs, records,
                                   own.removed, events, -1, nullptr, nullptr, &beside});
  }
  [[nodiscard]] grading::Result graded() const {
    return with_input([this](const grading::GradeInput& input) {
      return grading::grade(input, scenario.rubric);
    });
  }
  std::shared_ptr<const grading::ToothApart> apart;
};

}  // namespace cavum::testing
